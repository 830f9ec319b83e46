// Directional albedo: the answer of surfaces to light that arrives evenly, from all directions alike.
#pragma once

#include <cstdint>

#include "core/base/math/rgb.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/bsdf/bsdf.hpp"

namespace lightnet {

/// Radiance that the named lobes scatter to `outgoing` per irradiance (sr⁻¹), when light arrives evenly from the side
/// of `normal` (unit): exact for diffuse surfaces, else the mean of four directions. Black for opaque
/// surfaces seen from the other side.
Rgb evenly_scattered(const Bsdf& bsdf, Vec3 outgoing, Vec3 normal, std::uint8_t lobes);

}  // namespace lightnet
