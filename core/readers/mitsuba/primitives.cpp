#include "core/readers/mitsuba/primitives.hpp"

#include <array>
#include <cstdint>

namespace lightnet::mitsuba {
namespace {

struct Corner {
    Vec3 position, normal;
    Vec2 uv;
};

void quad(Mesh& mesh, const std::array<Corner, 4>& corners) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const auto& corner : corners) {
        mesh.positions.push_back(corner.position);
        mesh.normals.push_back(corner.normal);
        mesh.uvs.push_back(corner.uv);
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
}

}  // namespace

Mesh rectangle() {
    Mesh mesh;
    const Vec3 n{0, 0, 1};
    quad(mesh, {{{{-1, -1, 0}, n, {0, 1}}, {{1, -1, 0}, n, {1, 1}}, {{1, 1, 0}, n, {1, 0}}, {{-1, 1, 0}, n, {0, 0}}}});
    return mesh;
}

Mesh cube() {
    Mesh mesh;
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const float side : {-1.0f, 1.0f}) {
            Vec3 n, u, v;
            n[axis] = side, u[(axis + 1) % 3] = 1, v[(axis + 2) % 3] = side;  // u × v = n
            quad(mesh,
                 {{{n - u - v, n, {0, 1}}, {n + u - v, n, {1, 1}}, {n + u + v, n, {1, 0}}, {n - u + v, n, {0, 0}}}});
        }
    return mesh;
}

}  // namespace lightnet::mitsuba
