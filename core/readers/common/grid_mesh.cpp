#include "core/readers/common/grid_mesh.hpp"

namespace lightnet {

void add_cells(Mesh& mesh, std::uint32_t columns, std::uint32_t rows) {
    for (std::uint32_t j = 0; j + 1 < rows; ++j)
        for (std::uint32_t i = 0; i + 1 < columns; ++i) {
            const std::uint32_t a = j * columns + i, c = a + columns;
            mesh.triangles.push_back({a, a + 1, c + 1});
            mesh.triangles.push_back({a, c + 1, c});
        }
}

Mesh mesh_of_heights(std::uint32_t columns, std::uint32_t rows, std::span<const float> heights) {
    Mesh mesh;
    for (std::uint32_t j = 0; j < rows; ++j)
        for (std::uint32_t i = 0; i < columns; ++i) {
            const Vec2 at{float(i) / float(columns - 1), float(j) / float(rows - 1)};
            mesh.positions.push_back({at.x, at.y, heights[mesh.positions.size()]});
            mesh.uvs.push_back(at);
        }
    add_cells(mesh, columns, rows);
    return mesh;
}

}  // namespace lightnet
