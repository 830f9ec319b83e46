// The primaries in which pbrt's files may give colours.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/math/rgb.hpp"

namespace lightnet::pbrt {

enum class ColourSpace { srgb, dci_p3, rec2020, aces2065_1 };

/// As ColorSpace statements name it.
std::optional<ColourSpace> colour_space_named(const std::string& name);
const std::vector<std::string>& colour_space_names();

/// White stays white. Of what sRGB can't show some parts are below 0.
Rgb to_srgb(Rgb colour, ColourSpace from);
/// The light that counts as white in that space.
Rgb white_light(ColourSpace space);

}  // namespace lightnet::pbrt
