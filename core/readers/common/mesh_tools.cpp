#include "core/readers/common/mesh_tools.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace lightnet {
namespace {

Vec3 unit_or_zero(Vec3 v) {
    const float size = length(v);
    return size > 0 && std::isfinite(size) ? v / size : Vec3{};
}

/// The inverse transpose times the determinant's size: exists for singular transforms as well.
class NormalTransform {
public:
    explicit NormalTransform(const Matrix& t) {
        const auto& m = t.m;
        const double sign = swaps_handedness(t) ? -1 : 1;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) {
                const int a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
                cofactors_.m[i][j] = sign * (m[a][c] * m[b][d] - m[a][d] * m[b][c]);
            }
    }
    Vec3 operator()(Vec3 n) const { return unit_or_zero(transform_direction(cofactors_, n)); }

private:
    Matrix cofactors_;
};

Vec3 normal_of(const Mesh& mesh, const std::array<std::uint32_t, 3>& t) {
    return cross(mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]]);
}

float angle_between(Vec3 a, Vec3 b) {
    const float product = std::sqrt(length_squared(a) * length_squared(b));
    return product > 0 ? std::acos(std::clamp(dot(a, b) / product, -1.0f, 1.0f)) : 0;
}

struct Flat {
    double x = 0, y = 0;
};

double turn(Flat a, Flat b, Flat c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

/// A polygon seen along its normal, anticlockwise.
std::vector<Flat> flatten(std::span<const Vec3> positions, std::span<const std::uint32_t> corners) {
    double n[3] = {0, 0, 0};  // Newell's method: twice the area that each axis sees
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3 a = positions[corners[i]], b = positions[corners[(i + 1) % corners.size()]];
        n[0] += (double(a.y) - b.y) * (double(a.z) + b.z);
        n[1] += (double(a.z) - b.z) * (double(a.x) + b.x);
        n[2] += (double(a.x) - b.x) * (double(a.y) + b.y);
    }
    const auto axis =
        std::size_t(std::max_element(n, n + 3, [](double a, double b) { return std::fabs(a) < std::fabs(b); }) - n);
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::vector<Flat> flat;
    for (const auto corner : corners) {
        const Vec3 p = positions[corner];
        flat.push_back(n[axis] < 0 ? Flat{p[v], p[u]} : Flat{p[u], p[v]});
    }
    return flat;
}

bool convex(const std::vector<Flat>& flat) {
    const std::size_t n = flat.size();
    for (std::size_t i = 0; i < n; ++i)
        if (turn(flat[i], flat[(i + 1) % n], flat[(i + 2) % n]) < 0) return false;
    return true;
}

bool is_ear(const std::vector<Flat>& flat, const std::vector<std::size_t>& rest, std::size_t at) {
    const std::size_t n = rest.size(), i = rest[(at + n - 1) % n], j = rest[at], k = rest[(at + 1) % n];
    if (turn(flat[i], flat[j], flat[k]) <= 0) return false;
    return std::none_of(rest.begin(), rest.end(), [&](std::size_t other) {
        const Flat p = flat[other];
        return other != i && other != j && other != k && turn(flat[i], flat[j], p) >= 0 &&
               turn(flat[j], flat[k], p) >= 0 && turn(flat[k], flat[i], p) >= 0;
    });
}

}  // namespace

Vec3 moved_normal(Vec3 normal, const Matrix& to_world) { return NormalTransform(to_world)(normal); }

bool transform(Mesh& mesh, const Matrix& to_world) {
    const NormalTransform normal(to_world);
    bool good = true;
    for (auto& p : mesh.positions) {
        p = transform_point(to_world, p);
        good = good && finite(p);
    }
    for (auto& n : mesh.normals) n = normal(n);
    const float hand = swaps_handedness(to_world) ? -1 : 1;
    for (auto& t : mesh.tangents) t = {unit_or_zero(transform_direction(to_world, t.along)), t.hand * hand};
    return good;
}

void order_by_normals(Mesh& mesh) {
    for (auto& t : mesh.triangles) {
        Vec3 n = normal_of(mesh, t);
        if (mesh.flip_normals) n = -n;
        for (const auto i : t)
            if (length_squared(mesh.normals[i]) == 0) mesh.normals[i] = unit_or_zero(n);
        const Vec3 shading = mesh.normals[t[0]] + mesh.normals[t[1]] + mesh.normals[t[2]];
        if ((dot(n, shading) < 0) != mesh.flip_normals) std::swap(t[1], t[2]);
    }
    mesh.flip_normals = false;
}

void smooth_normals(Mesh& mesh) {
    mesh.normals.assign(mesh.positions.size(), {});
    for (const auto& t : mesh.triangles) {
        const Vec3 n = unit_or_zero(normal_of(mesh, t));
        for (int i = 0; i < 3; ++i) {
            const Vec3 p = mesh.positions[t[i]];
            const Vec3 a = mesh.positions[t[(i + 1) % 3]] - p, b = mesh.positions[t[(i + 2) % 3]] - p;
            mesh.normals[t[i]] += n * angle_between(a, b);
        }
    }
    for (auto& n : mesh.normals) n = unit_or_zero(n);
    if (mesh.flip_normals)
        for (auto& n : mesh.normals) n = -n;
    order_by_normals(mesh);
}

void flip(Mesh& mesh) {
    for (auto& n : mesh.normals) n = -n;
    if (mesh.normals.empty())
        mesh.flip_normals = !mesh.flip_normals;
    else
        for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
}

void triangulate(std::span<const Vec3> positions, std::span<const std::uint32_t> corners,
                 const std::function<void(std::uint32_t, std::uint32_t, std::uint32_t)>& triangle) {
    constexpr std::size_t most_ears = 256;  // cutting ears takes cubic time
    const auto flat =
        corners.size() > 3 && corners.size() <= most_ears ? flatten(positions, corners) : std::vector<Flat>();
    std::vector<std::size_t> rest;
    if (!flat.empty() && !convex(flat))
        for (std::size_t i = 0; i < corners.size(); ++i) rest.push_back(i);
    while (rest.size() > 3) {
        std::size_t ear = 0;
        while (ear < rest.size() && !is_ear(flat, rest, ear)) ++ear;
        if (ear == rest.size()) break;  // it meets itself: a fan is as good as anything
        const std::size_t n = rest.size();
        triangle(corners[rest[(ear + n - 1) % n]], corners[rest[ear]], corners[rest[(ear + 1) % n]]);
        rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    const auto corner = [&](std::size_t i) { return corners[rest.empty() ? i : rest[i]]; };
    const std::size_t left = rest.empty() ? corners.size() : rest.size();
    for (std::size_t i = 2; i < left; ++i) triangle(corner(0), corner(i - 1), corner(i));
}

void paint(Mesh& mesh, const std::vector<Rgb>& of_triangles) {
    Mesh painted;
    painted.flip_normals = mesh.flip_normals;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto first = static_cast<std::uint32_t>(painted.positions.size());
        for (const auto corner : mesh.triangles[i]) {
            painted.positions.push_back(mesh.positions[corner]);
            if (!mesh.normals.empty()) painted.normals.push_back(mesh.normals[corner]);
            if (!mesh.uvs.empty()) painted.uvs.push_back(mesh.uvs[corner]);
            painted.colours.push_back(of_triangles[i]);
        }
        painted.triangles.push_back({first, first + 1, first + 2});
    }
    mesh = std::move(painted);
}

}  // namespace lightnet
