#include "core/readers/mitsuba/primitives.hpp"

#include <cmath>
#include <functional>
#include <numbers>

namespace lightnet::mitsuba {
namespace {

constexpr double turn = 2 * std::numbers::pi;
constexpr int around = 128;

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

/// A surface over the unit square; its normal is ∂s × ∂t.
Mesh grid(int columns, int rows, const std::function<Corner(double s, double t)>& at) {
    Mesh mesh;
    for (int j = 0; j <= rows; ++j)
        for (int i = 0; i <= columns; ++i) {
            const Corner corner = at(double(i) / columns, double(j) / rows);
            mesh.positions.push_back(corner.position);
            mesh.normals.push_back(corner.normal);
            mesh.uvs.push_back(corner.uv);
        }
    const auto index = [&](int i, int j) { return static_cast<std::uint32_t>(j * (columns + 1) + i); };
    // at a pole corners meet
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        const auto apart = [&](std::uint32_t p, std::uint32_t q) {
            return length_squared(mesh.positions[p] - mesh.positions[q]) > 1e-12f;
        };
        if (apart(a, b) && apart(b, c) && apart(c, a)) mesh.triangles.push_back({a, b, c});
    };
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            add(index(i, j), index(i + 1, j), index(i + 1, j + 1));
            add(index(i, j), index(i + 1, j + 1), index(i, j + 1));
        }
    return mesh;
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

Mesh disk() {
    // the polygon is as large as the disk, so that a lamp keeps its power
    const double piece = turn / around, grow = std::sqrt(piece / std::sin(piece));
    return grid(around, 1, [&](double s, double t) -> Corner {
        const double r = 1 - t;
        return {{float(grow * r * std::cos(turn * s)), float(grow * r * std::sin(turn * s)), 0},
                {0, 0, 1},
                {float(r), float(1 - s)}};
    });
}

Mesh cylinder() {
    return grid(around, 1, [](double s, double t) -> Corner {
        const Vec3 n{float(std::cos(turn * s)), float(std::sin(turn * s)), 0};
        return {n + Vec3{0, 0, float(t)}, n, {float(s), float(1 - t)}};
    });
}

Mesh ball() {
    return grid(around, around / 2, [](double s, double t) -> Corner {
        const double theta = (1 - t) * turn / 2;  // from the lower pole
        const Vec3 n{float(std::sin(theta) * std::cos(turn * s)), float(std::sin(theta) * std::sin(turn * s)),
                     float(std::cos(theta))};
        return {n, n, {float(s), float(t)}};
    });
}

}  // namespace lightnet::mitsuba
