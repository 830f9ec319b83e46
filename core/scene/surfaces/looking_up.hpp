// Textures of many points.
#pragma once

#include <array>

#include "core/scene/surfaces/mesh_points.hpp"
#include "core/scene/surfaces/shading.hpp"

namespace lightnet {

// What is read of pictures is fetched for all before it is read for the first: the memory is waited for but once.
template <class Look>
void MeshPoints::look_up(Look&& look) const {
    std::array<TexturePlace, lanes> places;
    for (std::size_t k = 0; k < various_count_; ++k) {
        const std::uint32_t i = various_[k];
        const Hit& hit = hits_[i];
        const Shading& shading = *shapes_[i]->shading;
        places[k] = shading.coordinates(hit.geometry, hit.primitive, hit.u, hit.v);
        places[k].position = position_[i];
        places[k].normal = normal_[i];
        shading.expect_pictures(hit.geometry, places[k].uv);
    }
    for (std::size_t k = 0; k < various_count_; ++k) look(various_[k], places[k]);
}

}  // namespace lightnet
