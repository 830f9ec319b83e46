#include "core/scene/pbrt/shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include "core/scene/pbrt/quadrics.hpp"
#include "core/scene/pbrt/transforms.hpp"
#include "core/scene/ply.hpp"
#include "core/suggestion.hpp"

namespace lightnet::pbrt {
namespace {

constexpr float full_turn = 2 * std::numbers::pi_v<float>;

Vec3 unit_or_zero(Vec3 v) {
    const float size = length(v);
    return size > 0 && std::isfinite(size) ? v / size : Vec3{};
}

/// pbrt lets the shading normals decide on which side of a triangle its normal is. Vertices without a sound normal get
/// the one of a triangle.
void order_by_normals(Mesh& mesh) {
    for (auto& t : mesh.triangles) {
        Vec3 n = cross(mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]]);
        if (mesh.flip_normals) n = -n;
        for (const auto i : t)
            if (length_squared(mesh.normals[i]) == 0) mesh.normals[i] = unit_or_zero(n);
        const Vec3 shading = mesh.normals[t[0]] + mesh.normals[t[1]] + mesh.normals[t[2]];
        const bool against = dot(n, shading) < 0;
        if (against != mesh.flip_normals) std::swap(t[1], t[2]);
    }
    mesh.flip_normals = false;
}

/// Moves a mesh from its own space into the world; `turn` turns the shading normals.
std::optional<Geometry> place(Mesh mesh, Parameters& parameters, const Placement& placement, bool turn) {
    mesh.flip_normals = placement.flips();
    for (auto& p : mesh.positions) {
        p = transform_point(placement.to_world, p);
        if (finite(p)) continue;
        parameters.error("a vertex is not finite after the transforms");
        return std::nullopt;
    }
    for (auto& n : mesh.normals) {
        n = unit_or_zero(transform_normal(placement.from_world, n));
        if (turn) n = -n;
    }
    if (!mesh.normals.empty()) order_by_normals(mesh);
    return mesh;
}

/// The numbers of a parameter as vertex indices. None: reported.
std::optional<std::vector<std::uint32_t>> indices(Parameters& parameters, std::size_t vertices, std::size_t per_face) {
    std::vector<std::uint32_t> result;
    const Parameter* given = parameters.find("indices", Type::integer);
    if (!given && vertices == per_face) {
        for (std::uint32_t i = 0; i < per_face; ++i) result.push_back(i);
        return result;
    }
    if (!given) {
        parameters.error(fmt::format("parameter 'indices' is missing (only {} vertices need none)", per_face));
        return std::nullopt;
    }
    if (given->integers.size() % per_face) {
        parameters.error(fmt::format("{} indices are no multiple of {}", given->integers.size(), per_face));
        return std::nullopt;
    }
    for (const auto i : given->integers) {
        if (i < 0 || static_cast<std::size_t>(i) >= vertices) {
            parameters.error(fmt::format("index {} is out of range: there are {} vertices", i, vertices));
            return std::nullopt;
        }
        result.push_back(static_cast<std::uint32_t>(i));
    }
    return result;
}

/// Vertices as the parameters of trianglemesh and bilinearmesh give them. None: reported.
std::optional<Mesh> vertices(Parameters& parameters) {
    Mesh mesh;
    mesh.positions = parameters.triples("P", Type::point3);
    mesh.normals = parameters.triples("N", Type::normal);
    mesh.uvs = parameters.pairs(parameters.find("st") ? "st" : "uv", Type::point2);
    parameters.ignore({"S", "faceIndices", "uv"});
    const std::size_t count = mesh.positions.size();
    if (count == 0) {
        parameters.error("parameter 'P' is missing");
        return std::nullopt;
    }
    const auto fits = [&](std::size_t size, const char* what) {
        if (size == 0 || size == count) return true;
        parameters.error(fmt::format("there are {} '{}' for {} vertices", size, what, count));
        return false;
    };
    const bool good = fits(mesh.normals.size(), "N") & fits(mesh.uvs.size(), "uv");
    return good ? std::optional(std::move(mesh)) : std::nullopt;
}

std::optional<Geometry> triangle_mesh(Parameters& parameters, const Sources&, const Placement& placement) {
    auto mesh = vertices(parameters);
    if (!mesh) return std::nullopt;
    const auto corners = indices(parameters, mesh->positions.size(), 3);
    if (!corners) return std::nullopt;
    for (std::size_t i = 0; i < corners->size(); i += 3)
        mesh->triangles.push_back({(*corners)[i], (*corners)[i + 1], (*corners)[i + 2]});
    return place(std::move(*mesh), parameters, placement, placement.reversed);
}

bool planar(const Mesh& mesh, const std::array<std::uint32_t, 4>& patch) {
    const auto& p = mesh.positions;
    const Vec3 a = p[patch[1]] - p[patch[0]], b = p[patch[2]] - p[patch[0]], c = p[patch[3]] - p[patch[0]];
    const float size = std::max({length(a), length(b), length(c)});
    return std::fabs(dot(cross(a, b), c)) <= 1e-4f * size * size * size;
}

std::optional<Geometry> bilinear_mesh(Parameters& parameters, const Sources&, const Placement& placement) {
    auto mesh = vertices(parameters);
    if (!mesh) return std::nullopt;
    const auto corners = indices(parameters, mesh->positions.size(), 4);
    if (!corners) return std::nullopt;
    if (mesh->uvs.empty() && mesh->positions.size() == 4) mesh->uvs = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
    for (std::size_t i = 0; i < corners->size(); i += 4) {
        const std::array<std::uint32_t, 4> p{(*corners)[i], (*corners)[i + 1], (*corners)[i + 2], (*corners)[i + 3]};
        if (!planar(*mesh, p)) parameters.warn("a bilinear patch that is not flat is taken for two triangles");
        // the order of pbrt's corners is (0, 0), (1, 0), (0, 1), (1, 1)
        mesh->triangles.push_back({p[0], p[1], p[3]});
        mesh->triangles.push_back({p[0], p[3], p[2]});
    }
    return place(std::move(*mesh), parameters, placement, placement.reversed);
}

std::optional<Geometry> ply_mesh(Parameters& parameters, const Sources& sources, const Placement& placement) {
    const std::string file = parameters.text("filename", "");
    if (parameters.find("displacement")) parameters.warn("displacement is left out");
    parameters.ignore({"edgelength"});
    if (file.empty()) {
        parameters.error("parameter 'filename' is missing");
        return std::nullopt;
    }
    if (file.ends_with(".gz")) {
        parameters.error(fmt::format("'{}' is compressed; only plain PLY files are read", file));
        return std::nullopt;
    }
    const auto bytes = sources.read(file, parameters.where());
    if (!bytes) return std::nullopt;
    try {
        return place(read_ply(**bytes), parameters, placement, placement.reversed);
    } catch (const Error& problem) {
        parameters.error(fmt::format("'{}': {}", file, problem.what()));
        return std::nullopt;
    }
}

/// The axes of a transform that scales all directions alike: its rotation (and mirroring) alone.
Matrix axes_of(const Matrix& matrix, double scale) {
    Matrix axes;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) axes.m[i][j] = matrix.m[i][j] / scale;
    return axes;
}

std::optional<Geometry> sphere(Parameters& parameters, const Sources&, const Placement& placement) {
    const float radius = parameters.number("radius", 1);
    if (!(radius > 0)) {
        parameters.error("the radius must be above 0");
        return std::nullopt;
    }
    SpherePart part{radius, parameters.number("zmin", -radius), parameters.number("zmax", radius),
                    parameters.number("phimax", 360) / 360 * full_turn};
    if (part.z_min > part.z_max) std::swap(part.z_min, part.z_max);
    part.phi_max = std::clamp(part.phi_max, 0.0f, full_turn);
    const auto scale = uniform_scale(placement.to_world);
    const bool whole = part.z_min <= -radius && part.z_max >= radius && part.phi_max >= full_turn;
    if (whole && scale) {
        const Vec3 center = transform_point(placement.to_world, {});
        const float size = float(radius * *scale);
        if (finite(center) && std::isfinite(size) && size > 0)
            return Sphere{center, size, placement.flips(), axes_of(placement.to_world, *scale)};
        parameters.error("centre or radius is not finite after the transforms");
        return std::nullopt;
    }
    parameters.warn(whole ? "a sphere that is scaled unevenly is cut into triangles"
                          : "a part of a sphere is cut into triangles");
    return place(sphere_mesh(part), parameters, placement, placement.flips());
}

std::optional<Geometry> disk(Parameters& parameters, const Sources&, const Placement& placement) {
    parameters.warn("a disk is cut into triangles");
    return place(disk_mesh(parameters), parameters, placement, placement.flips());
}

std::optional<Geometry> cylinder(Parameters& parameters, const Sources&, const Placement& placement) {
    parameters.warn("a cylinder is cut into triangles");
    return place(cylinder_mesh(parameters), parameters, placement, placement.flips());
}

std::optional<Geometry> subdivision(Parameters& parameters, const Sources& sources, const Placement& placement) {
    parameters.ignore({"levels", "scheme"});
    parameters.warn("a subdivision surface is taken as its control mesh");
    return triangle_mesh(parameters, sources, placement);
}

using Maker = std::optional<Geometry> (*)(Parameters&, const Sources&, const Placement&);

const std::map<std::string, Maker>& makers() {
    static const std::map<std::string, Maker> table{
        {"trianglemesh", triangle_mesh}, {"plymesh", ply_mesh}, {"sphere", sphere},
        {"bilinearmesh", bilinear_mesh}, {"disk", disk},        {"cylinder", cylinder},
        {"loopsubdiv", subdivision}};
    return table;
}

}  // namespace

std::optional<Geometry> make_shape(const std::string& type, Parameters& parameters, const Sources& sources,
                                   const Placement& placement) {
    if (const Parameter* alpha = parameters.find("alpha");
        alpha && (alpha->type != Type::number || alpha->numbers[0] < 1))
        parameters.warn("transparency by 'alpha' is left out");
    if (type == "curve") {
        parameters.ignore_all();
        parameters.warn("curves are left out");
        return std::nullopt;
    }
    if (const auto maker = makers().find(type); maker != makers().end())
        return maker->second(parameters, sources, placement);
    std::vector<std::string> known;
    for (const auto& [name, maker] : makers()) known.push_back(name);
    parameters.error("unknown shape" + did_you_mean(type, known));
    parameters.ignore_all();
    return std::nullopt;
}

Geometry moved(const Geometry& geometry, const Placement& placement) {
    const Matrix& to_world = placement.to_world;
    const auto scale = uniform_scale(to_world);
    if (const auto* ball = std::get_if<Sphere>(&geometry); ball && scale) {
        // pbrt moves the normal with the surface, so a mirroring doesn't turn it
        return Sphere{transform_point(to_world, ball->center), float(ball->radius * *scale), ball->flip_normals,
                      axes_of(to_world, *scale) * ball->to_world};
    }
    Mesh mesh;
    if (const auto* ball = std::get_if<Sphere>(&geometry)) {
        mesh = sphere_mesh({ball->radius, -ball->radius, ball->radius, full_turn});
        for (auto& p : mesh.positions) p = ball->center + transform_direction(ball->to_world, p);
        for (auto& n : mesh.normals) n = transform_direction(ball->to_world, n) * (ball->flip_normals ? -1.0f : 1.0f);
        order_by_normals(mesh);
    } else {
        mesh = std::get<Mesh>(geometry);
    }
    for (auto& p : mesh.positions) p = transform_point(to_world, p);
    for (auto& n : mesh.normals) n = unit_or_zero(transform_normal(placement.from_world, n));
    mesh.flip_normals = mesh.flip_normals != swaps_handedness(to_world);
    return mesh;
}

double area_of(const Geometry& geometry) {
    if (const auto* ball = std::get_if<Sphere>(&geometry))
        return 4 * std::numbers::pi * double(ball->radius) * double(ball->radius);
    double area = 0;
    const auto& mesh = std::get<Mesh>(geometry);
    for (const auto& t : mesh.triangles)
        area += 0.5 * double(length(cross(mesh.positions[t[1]] - mesh.positions[t[0]],
                                          mesh.positions[t[2]] - mesh.positions[t[0]])));
    return area;
}

}  // namespace lightnet::pbrt
