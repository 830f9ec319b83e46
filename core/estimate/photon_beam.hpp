// A stretch of a light path through a medium.
#pragma once

#include <cstdint>
#include <type_traits>

#include "core/base/math/rgb.hpp"
#include "core/base/math/vec.hpp"

namespace lightnet {

/// A photon beam (Jarosz et al. 2011, "A Comprehensive Theory of Volumetric Radiance Estimation using Photon Points and
/// Beams"): light on its way, of which every point in the medium gets what has come that far. Made by PhotonShooter.
struct PhotonBeam {
    Vec3 from, along;         // along: unit
    float length = 0;         // m
    Rgb flux;                 // W, at its beginning
    Rgb extinction;           // per metre, on average from there to its end
    std::uint32_t group = 0;  // of its lamp

    Vec3 to() const { return from + along * length; }
};

static_assert(sizeof(PhotonBeam) == 56 && std::is_trivially_copyable_v<PhotonBeam>, "beams travel as bytes");

}  // namespace lightnet
