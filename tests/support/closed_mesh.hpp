// What a mesh is as a whole.
#pragma once

#include <algorithm>
#include <map>
#include <utility>

#include "core/scene/data/scene_data.hpp"

namespace lightnet::test {

/// How many edges belong to other than two triangles: 0 of a closed surface without cracks.
inline std::size_t open_edges(const Mesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> triangles;
    for (const auto& t : mesh.triangles)
        for (std::size_t i = 0; i < 3; ++i) ++triangles[std::minmax(t[i], t[(i + 1) % 3])];
    return std::size_t(
        std::count_if(triangles.begin(), triangles.end(), [](const auto& edge) { return edge.second != 2; }));
}

inline float longest_edge(const Mesh& mesh) {
    float longest = 0;
    for (const auto& t : mesh.triangles)
        for (std::size_t i = 0; i < 3; ++i)
            longest = std::max(longest, length(mesh.positions[t[i]] - mesh.positions[t[(i + 1) % 3]]));
    return longest;
}

}  // namespace lightnet::test
