#include "core/readers/pbrt/meshes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/readers/common/mesh_tools.hpp"
#include "core/readers/pbrt/subdivision.hpp"

namespace lightnet::pbrt {
namespace {

Vec3 unit_or_zero(Vec3 v) {
    const float size = length(v);
    return size > 0 && std::isfinite(size) ? v / size : Vec3{};
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
    result.reserve(given->integers.size());
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
    parameters.ignore({"faceIndices", "uv"});
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
    const bool normals = fits(mesh.normals.size(), "N"), uvs = fits(mesh.uvs.size(), "uv");  // both are told
    return normals && uvs ? std::optional(std::move(mesh)) : std::nullopt;
}

/// The corners of a bilinear patch: (u, v) = (0, 0), (1, 0), (0, 1), (1, 1).
using Patch = std::array<std::uint32_t, 4>;

bool planar(const Mesh& mesh, const Patch& patch) {
    const auto& p = mesh.positions;
    const Vec3 a = p[patch[1]] - p[patch[0]], b = p[patch[2]] - p[patch[0]], c = p[patch[3]] - p[patch[0]];
    const float size = std::max({length(a), length(b), length(c)});
    return std::fabs(dot(cross(a, b), c)) <= 1e-4f * size * size * size;
}

/// Adds a patch that is bent, as a net of small triangles.
void add_bent(Mesh& mesh, const Patch& patch) {
    constexpr std::uint32_t pieces = 8;
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const auto between = [&](auto& values, float u, float v) {
        values.push_back((values[patch[0]] * (1 - u) + values[patch[1]] * u) * (1 - v) +
                         (values[patch[2]] * (1 - u) + values[patch[3]] * u) * v);
    };
    for (std::uint32_t j = 0; j <= pieces; ++j)
        for (std::uint32_t i = 0; i <= pieces; ++i) {
            const float u = float(i) / pieces, v = float(j) / pieces;
            between(mesh.positions, u, v);
            if (!mesh.normals.empty()) between(mesh.normals, u, v);
            if (!mesh.uvs.empty()) between(mesh.uvs, u, v);
        }
    for (std::uint32_t j = 0; j < pieces; ++j)
        for (std::uint32_t i = 0; i < pieces; ++i) {
            const std::uint32_t a = first + j * (pieces + 1) + i, c = a + pieces + 1;
            mesh.triangles.push_back({a, a + 1, c + 1});
            mesh.triangles.push_back({a, c + 1, c});
        }
}

}  // namespace

std::optional<Mesh> triangle_mesh(Parameters& parameters) {
    auto mesh = vertices(parameters);
    if (!mesh) return std::nullopt;
    const auto corners = indices(parameters, mesh->positions.size(), 3);
    const auto tangents = parameters.triples("S", Type::vector3);
    if (!tangents.empty() && tangents.size() != mesh->positions.size())
        parameters.error(fmt::format("there are {} 'S' for {} vertices", tangents.size(), mesh->positions.size()));
    else
        for (const Vec3 along : tangents) mesh->tangents.push_back({along, 1});
    if (!corners) return std::nullopt;
    for (std::size_t i = 0; i < corners->size(); i += 3)
        mesh->triangles.push_back({(*corners)[i], (*corners)[i + 1], (*corners)[i + 2]});
    return mesh;
}

std::optional<Mesh> bilinear_mesh(Parameters& parameters) {
    auto mesh = vertices(parameters);
    if (const std::string file = parameters.text("emissionfilename", ""); !file.empty())
        parameters.warn("'emissionfilename' is left out: the lamp is equally bright everywhere");
    if (!mesh) return std::nullopt;
    const auto corners = indices(parameters, mesh->positions.size(), 4);
    if (!corners) return std::nullopt;
    if (mesh->uvs.empty() && mesh->positions.size() == 4) mesh->uvs = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
    for (std::size_t i = 0; i < corners->size(); i += 4) {
        const Patch p{(*corners)[i], (*corners)[i + 1], (*corners)[i + 2], (*corners)[i + 3]};
        if (planar(*mesh, p)) {
            mesh->triangles.push_back({p[0], p[1], p[3]});
            mesh->triangles.push_back({p[0], p[3], p[2]});
        } else {
            parameters.warn("a bilinear patch that is bent is cut into triangles");
            add_bent(*mesh, p);
        }
    }
    return mesh;
}

std::optional<Mesh> subdivision_mesh(Parameters& parameters) {
    constexpr std::uint64_t most_triangles = std::uint64_t{1} << 24;
    parameters.ignore({"scheme"});
    const int levels = parameters.integer(parameters.find("nlevels") ? "nlevels" : "levels", 3);
    auto control = triangle_mesh(parameters);
    if (!control) return std::nullopt;
    if (levels < 0 || levels > 12 || (control->triangles.size() << (2 * levels)) > most_triangles) {
        parameters.error(
            fmt::format("{} levels of subdivision would make more than 2^24 triangles, or less than none", levels));
        return std::nullopt;
    }
    Mesh fine = subdivide(*control, levels);
    // pbrt goes around its vertices clockwise, so that its normals lie on the other side
    for (auto& n : fine.normals) n = -n;
    return fine;
}

std::string place(Mesh& mesh, const Placement& placement, bool turn) {
    mesh.flip_normals = placement.flips();
    for (auto& p : mesh.positions) {
        p = transform_point(placement.to_world, p);
        if (!finite(p)) return "a vertex is not finite after the transforms";
    }
    for (auto& n : mesh.normals) {
        n = unit_or_zero(transform_normal(placement.from_world, n));
        if (turn) n = -n;
    }
    for (auto& t : mesh.tangents) t.along = unit_or_zero(transform_direction(placement.to_world, t.along));
    if (!mesh.normals.empty()) order_by_normals(mesh);
    return {};
}

}  // namespace lightnet::pbrt
