// Coarse regions of scene and picture: questions of one region go to the same replica, whose cache knows it (affinity).
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/base/query.hpp"
#include "core/film/tile.hpp"

namespace lightnet {

/// Questions without a place in scene or picture share one region.
template <class Question>
std::uint64_t region_of(const Question&) {
    return 0;
}

/// A quarter by a quarter of a primitive, or 64 neighbouring small ones. Coordinates are of -1 to 1 (spheres have
/// negative ones); what is out of that, or no number, comes from strangers, and has a region as well.
inline std::uint64_t region_of(const Query& query) {
    const auto quarter = [](float coordinate) {
        const float within = coordinate >= -1 ? std::min(coordinate, 1.0f) : -1;
        return static_cast<std::uint64_t>(static_cast<std::int64_t>(within * 3.999f)) & 3;
    };
    std::uint64_t region = query.instance;
    region = region * 0x9e3779b97f4a7c15ull + query.geometry;
    region = region * 0x9e3779b97f4a7c15ull + query.primitive / 64;
    return region * 16 + quarter(query.u) * 4 + quarter(query.v);
}

/// 64 by 64 pixels.
inline std::uint64_t region_of(const Tile& tile) { return (std::uint64_t{tile.y / 64} << 32) | (tile.x / 64); }

}  // namespace lightnet
