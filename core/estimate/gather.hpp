// Asks a node's input how bright other surfaces look from a point.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/math/random.hpp"
#include "core/network/light/inputs.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {

/// A look from a surface to others.
struct SurfaceLook {
    Ray ray;
    Key stream = 0;            // of its own random numbers, and of the questions about what it meets
    std::uint32_t sample = 0;  // index within the stream
    std::uint8_t depth = 0;    // scattering events between the eye and the point from which it looks
};

/// What a look saw.
struct Seen {
    Rgb light;       // radiance arriving that some surface has scattered (what shines by itself is direct light)
    float distance;  // m, to the first surface; infinite where there is none
};

/// Follows looks, through mirrors and glass, to surfaces that scatter in other ways too, and asks input `index` about
/// all of these at once; nobody else's rays decide what a look finds.
void look_around(const Scene& scene, const Inputs& inputs, std::size_t index, std::span<const SurfaceLook> looks,
                 std::span<Seen> seen);

}  // namespace lightnet
