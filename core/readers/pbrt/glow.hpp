// Light that hot media give.
#pragma once

#include <memory>

#include "core/scene/media/medium.hpp"

namespace lightnet::pbrt {

/// The temperature of a medium, in kelvin: (what the grid says - offset) × scale.
struct Heat {
    VolumeField grid;
    float offset = 0, scale = 1;
};

/// At the points of a density's grid: the density times the light of a black body, of radiance 1 at its brightest
/// wavelength as pbrt has it; none up to 100 K. Null: none at all. Throws Error where that takes much more memory than
/// what it is made of.
std::shared_ptr<const VolumeGrid> glowing(const VolumeField& density, const Heat& heat);

/// At the points of the first, both times each other. Grids without blocks, of the same size, and of one channel or as
/// many.
std::shared_ptr<const VolumeGrid> product_of(const VolumeGrid& a, const VolumeGrid& b);

}  // namespace lightnet::pbrt
