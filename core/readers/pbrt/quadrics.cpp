#include "core/readers/pbrt/quadrics.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>

namespace lightnet::pbrt {
namespace {

constexpr int around = 128;  // pieces of a full turn

struct Corner {
    Vec3 position, normal;
};

/// A surface over (u, v) in the unit square; its normal is ∂u × ∂v.
Mesh tessellate(int columns, int rows, const std::function<Corner(double u, double v)>& at) {
    Mesh mesh;
    for (int j = 0; j <= rows; ++j)
        for (int i = 0; i <= columns; ++i) {
            const double u = double(i) / columns, v = double(j) / rows;
            const Corner corner = at(u, v);
            mesh.positions.push_back(corner.position);
            mesh.normals.push_back(corner.normal);
            mesh.uvs.push_back({float(u), float(v)});
        }
    const auto index = [&](int i, int j) { return static_cast<std::uint32_t>(j * (columns + 1) + i); };
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            mesh.triangles.push_back({index(i, j), index(i + 1, j), index(i + 1, j + 1)});
            mesh.triangles.push_back({index(i, j), index(i + 1, j + 1), index(i, j + 1)});
        }
    return mesh;
}

double phi_max(Parameters& parameters) {
    return std::clamp(double(parameters.number("phimax", 360)), 0.0, 360.0) * std::numbers::pi / 180;
}

int pieces(double angle) { return std::max(1, static_cast<int>(std::ceil(around * angle / (2 * std::numbers::pi)))); }

}  // namespace

Mesh sphere_mesh(const SpherePart& part) {
    const double r = part.radius;
    const double low = std::acos(std::clamp(part.z_min / r, -1.0, 1.0));
    const double high = std::acos(std::clamp(part.z_max / r, -1.0, 1.0));
    return tessellate(pieces(part.phi_max), pieces(low - high), [&](double u, double v) -> Corner {
        const double phi = u * part.phi_max, theta = low + v * (high - low);
        const Vec3 n{float(std::sin(theta) * std::cos(phi)), float(std::sin(theta) * std::sin(phi)),
                     float(std::cos(theta))};
        return {n * part.radius, n};
    });
}

Mesh disk_mesh(Parameters& parameters) {
    const double height = parameters.number("height", 0), radius = parameters.number("radius", 1);
    const double inner = parameters.number("innerradius", 0), phi = phi_max(parameters);
    const int columns = pieces(phi);
    // the polygon is as large as the disk, so that a lamp keeps its power
    const double piece = phi / columns, grow = piece > 0 ? std::sqrt(piece / std::sin(piece)) : 1;
    return tessellate(columns, 1, [&](double u, double v) -> Corner {
        const double r = grow * (radius + v * (inner - radius));
        return {{float(r * std::cos(u * phi)), float(r * std::sin(u * phi)), float(height)}, {0, 0, 1}};
    });
}

Mesh cylinder_mesh(Parameters& parameters) {
    const double radius = parameters.number("radius", 1), phi = phi_max(parameters);
    const double z_min = parameters.number("zmin", -1), z_max = parameters.number("zmax", 1);
    return tessellate(pieces(phi), 1, [&](double u, double v) -> Corner {
        const Vec3 n{float(std::cos(u * phi)), float(std::sin(u * phi)), 0};
        return {n * float(radius) + Vec3{0, 0, float(z_min + v * (z_max - z_min))}, n};
    });
}

}  // namespace lightnet::pbrt
