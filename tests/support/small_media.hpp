// Fog and lumps of smoke for tests.
#pragma once

#include <memory>

#include "core/scene/media/medium.hpp"

namespace lightnet::test {

/// Without `g`: alike in all directions. Coefficients per metre.
inline Medium fog(Rgb extinction, Rgb albedo, float g = 0) {
    Medium medium;
    medium.extinction.value = extinction;
    medium.albedo.value = albedo;
    if (g != 0) medium.phase.law = PhaseFunction::Law::henyey_greenstein, medium.phase.g = g;
    return medium;
}

/// Uneven in the unit cube, colours differ; at its densest `extinction` in red.
inline Medium lumps(float extinction, float albedo) {
    Medium medium = fog({extinction, extinction / 2, extinction / 4}, {albedo, albedo, albedo}, 0.3f);
    VolumeGrid grid;
    grid.size = {4, 4, 4};
    for (int i = 0; i < 64; ++i) grid.values.push_back(float(i * 7 % 5) / 4);
    medium.extinction.grid = std::make_shared<const VolumeGrid>(grid);
    return medium;
}

}  // namespace lightnet::test
