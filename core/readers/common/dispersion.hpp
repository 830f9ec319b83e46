// Glass that bends light of each colour by its own index.
#pragma once

#include <optional>
#include <string_view>

#include "core/base/math/rgb.hpp"
#include "core/scene/bsdf/principled.hpp"

namespace lightnet {

inline constexpr std::string_view three_indices =
    "dispersion is approximated by three indices, for red, green and blue: rainbows have three colours";
inline constexpr std::string_view one_index = "dispersion is left out: the index of green light is taken";

/// A solid of such glass, by its indices of refraction; `white` is a texture. None: red and blue are bent alike, or the
/// other way round than glass bends them, and the index of green says all.
std::optional<PrincipledMaterial> dispersing_glass(const Rgb& indices, const Roughness& roughness, TextureId white);

}  // namespace lightnet
