// Statistics of a scene.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/base/math/box.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet {

struct SceneStatistics {
    std::uint64_t triangles = 0;                              // in memory
    std::uint64_t instanced_triangles = 0;                    // in the world: those of objects once for each instance
    std::vector<std::pair<const char*, std::size_t>> shapes;  // of each kind, by what several are called
    std::size_t objects = 0, instances = 0;
    std::map<std::string, std::size_t> materials;  // that shapes have, by model
    std::map<std::string, std::size_t> lights;     // by what they are
    std::size_t textures = 0, images = 0;
    std::uint64_t geometry_bytes = 0, image_bytes = 0;
    Box bounds;  // around everything; a point where there is nothing
};

SceneStatistics statistics_of(const SceneData& scene);

}  // namespace lightnet
