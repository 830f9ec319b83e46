#include "core/readers/pbrt/relief.hpp"

#include <fmt/format.h>

#include "core/readers/common/split_edges.hpp"
#include "core/readers/pbrt/meshes.hpp"
#include "core/scene/textures/look_up.hpp"

namespace lightnet::pbrt {

std::string raise(Mesh& mesh, const Relief& relief, std::span<const Texture> textures) {
    constexpr std::uint64_t most = std::uint64_t{1} << 24;
    const Placement& placement = relief.placement;
    if (!(relief.edge > 0)) return "'edgelength' must be above 0";
    if (mesh.uvs.empty()) return "displacement needs texture coordinates, which the mesh does not have";
    if (mesh.normals.empty()) normals_of_faces(mesh);
    if (!split_edges(mesh, placement.to_world, relief.edge, most))
        return fmt::format("an 'edgelength' of {:g} would make more than 2^24 triangles", relief.edge);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const TexturePlace place{mesh.uvs[i],
                                 {1, 1, 1},
                                 transform_point(placement.to_world, mesh.positions[i]),
                                 transform_normal(placement.from_world, mesh.normals[i])};
        mesh.positions[i] += mesh.normals[i] * value_at(textures, relief.heights, place).r;
    }
    normals_of_faces(mesh);
    return place(mesh, placement, placement.reversed);
}

}  // namespace lightnet::pbrt
