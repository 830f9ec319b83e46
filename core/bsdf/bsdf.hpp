// How one point of a surface scatters light.
#pragma once

#include <cstdint>
#include <optional>
#include <variant>

#include "core/light/query.hpp"
#include "core/math/frame.hpp"
#include "core/math/rgb.hpp"
#include "core/math/samples.hpp"
#include "core/math/vec.hpp"

namespace lightnet {

/// A sampled direction of incoming light.
struct BsdfSample {
    Vec3 incoming;                  // unit, world space, away from the surface
    Rgb weight;                     // f × |cos| / pdf
    float pdf = 0;                  // per steradian, over all lobes asked for; meaningless for a specular lobe
    std::uint8_t lobe = 0;          // the one that was sampled: one of lobe::diffuse, glossy, specular
    bool transmitted = false;
};

/// A GGX roughness below this is taken for a perfect mirror. One threshold for renderer, light operators and checks.
inline constexpr float specular_alpha = 1e-3f;

/// Scattering at one point, textures already looked up. A value: make it, use it, drop it. Both directions are unit,
/// in world space and point away from the surface.
class Bsdf {
public:
    /// Which lobes the surface has.
    std::uint8_t lobes() const;
    /// f × |cos incoming| for the non-specular lobes among `lobes`, sr⁻¹. Exactly 0 for specular ones.
    Rgb evaluate(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const;
    /// Density with which sample() with the same `lobes` finds `incoming`, per steradian; specular lobes don't count.
    float pdf(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const;
    /// One direction of light, by importance. None: absorbed.
    std::optional<BsdfSample> sample(Vec3 outgoing, float choice, Vec2 u, std::uint8_t lobes) const;
};

}  // namespace lightnet
