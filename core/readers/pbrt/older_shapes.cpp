#include "core/readers/pbrt/older_shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/readers/common/grid_mesh.hpp"

namespace lightnet::pbrt {
namespace {

constexpr std::uint32_t around = 128, along = 32;  // pieces of a surface of revolution

/// What a curve passes over when it turns around the z axis; `profile` from 0 to 1. As in pbrt, its normal is that of
/// the turn times the way along the curve.
template <class Profile>
Mesh turned(Parameters& parameters, const Profile& profile) {
    parameters.warn("it is cut into triangles");
    const float turn = std::clamp(parameters.number("phimax", 360), 0.0f, 360.0f) * std::numbers::pi_v<float> / 180;
    Mesh mesh;
    for (std::uint32_t j = 0; j <= along; ++j)
        for (std::uint32_t i = 0; i <= around; ++i) {
            constexpr float step = 1e-3f;
            const float u = float(i) / around, v = float(j) / along, c = std::cos(turn * u), s = std::sin(turn * u);
            const auto at = [&](float w) {
                const Vec3 p = profile(w);
                return Vec3{p.x * c - p.y * s, p.x * s + p.y * c, p.z};
            };
            const float middle = std::clamp(v, step, 1 - step);
            const Vec3 p = at(v), near = at(middle);
            mesh.positions.push_back(p);
            mesh.normals.push_back(normalize(cross(Vec3{-near.y, near.x, 0}, at(middle + step) - at(middle - step))));
            mesh.uvs.push_back({u, v});
        }
    add_cells(mesh, around + 1, along + 1);
    return mesh;
}

bool is_above_0(float value, const char* what, Parameters& parameters) {
    if (!(value > 0)) parameters.error(fmt::format("'{}' must be above 0", what));
    return value > 0;
}

Vec3 point_of(Parameters& parameters, const char* name, Vec3 fallback) {
    const auto given = parameters.triples(name, Type::point3);
    return given.size() == 1 ? given[0] : fallback;
}

}  // namespace

std::optional<Mesh> height_field(Parameters& parameters) {
    const int columns = parameters.integer("nu", 0), rows = parameters.integer("nv", 0);
    const Parameter* heights = parameters.find("Pz", Type::number);
    const std::size_t given = heights ? heights->numbers.size() : 0;
    if (columns < 2 || rows < 2 || std::uint64_t(columns) * std::uint64_t(rows) != given) {
        parameters.error(fmt::format("'Pz' needs nu × nv heights, at least 2 × 2: there are {}", given));
        return std::nullopt;
    }
    return mesh_of_heights(std::uint32_t(columns), std::uint32_t(rows), heights->numbers);
}

std::optional<Mesh> cone(Parameters& parameters) {
    const float radius = parameters.number("radius", 1), height = parameters.number("height", 1);
    if (!is_above_0(radius, "radius", parameters)) return std::nullopt;
    return turned(parameters, [&](float v) { return Vec3{radius * (1 - v), 0, height * v}; });
}

std::optional<Mesh> paraboloid(Parameters& parameters) {
    const float radius = parameters.number("radius", 1), low = parameters.number("zmin", 0),
                high = parameters.number("zmax", 1);
    const float most = std::max(low, high), least = std::max(0.0f, std::min(low, high));
    if (!is_above_0(radius, "radius", parameters) || !is_above_0(most, "zmax", parameters)) return std::nullopt;
    return turned(parameters, [&](float v) {
        const float z = least + (most - least) * v;
        return Vec3{radius * std::sqrt(z / most), 0, z};
    });
}

std::optional<Mesh> hyperboloid(Parameters& parameters) {
    const Vec3 first = point_of(parameters, "p1", {0, 0, 0}), second = point_of(parameters, "p2", {1, 1, 1});
    return turned(parameters, [&](float v) { return first * (1 - v) + second * v; });
}

}  // namespace lightnet::pbrt
