#include "core/readers/pbrt/subdivision.hpp"

#include "core/base/unwanted.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <unordered_map>
#include <utility>

namespace lightnet::pbrt {
namespace {

/// An edge, and the corners of its faces that lie opposite.
struct Edge {
    std::uint32_t a = 0, b = 0;
    Vec3 opposite;  // their sum
    std::uint32_t faces = 0;
    std::uint32_t middle = 0;  // the vertex that comes to lie on it
    bool boundary() const { return faces != 2; }
};

/// What a vertex has around it.
struct Ring {
    Vec3 sum, boundary_sum;  // of its neighbours, and of those along boundaries
    std::uint32_t neighbours = 0, boundaries = 0;
};

std::uint64_t key_of(std::uint32_t a, std::uint32_t b) {
    return (std::uint64_t{std::min(a, b)} << 32) | std::max(a, b);
}

/// The edges of a mesh in the order in which its triangles name them.
class Edges {
public:
    explicit Edges(const Mesh& mesh) {
        index_.reserve(mesh.triangles.size() * 2);
        for (const auto& t : mesh.triangles) {
            end_if_unwanted();
            for (int i = 0; i < 3; ++i) {
                const auto a = t[i], b = t[(i + 1) % 3];
                const auto [at, fresh] = index_.try_emplace(key_of(a, b), all.size());
                if (fresh) all.push_back({a, b, {}, 0, 0});
                Edge& edge = all[at->second];
                edge.opposite = edge.opposite + mesh.positions[t[(i + 2) % 3]];
                ++edge.faces;
            }
        }
    }
    const Edge& between(std::uint32_t a, std::uint32_t b) const { return all[index_.find(key_of(a, b))->second]; }

    std::vector<Edge> all;

private:
    std::unordered_map<std::uint64_t, std::size_t> index_;
};

std::vector<Ring> rings_of(const Mesh& mesh, const Edges& edges) {
    std::vector<Ring> rings(mesh.positions.size());
    const auto meet = [&](std::uint32_t vertex, std::uint32_t other, bool boundary) {
        Ring& ring = rings[vertex];
        const Vec3 p = mesh.positions[other];
        ring.sum = ring.sum + p;
        ++ring.neighbours;
        if (!boundary) return;
        ring.boundary_sum = ring.boundary_sum + p;
        ++ring.boundaries;
    };
    for (const Edge& edge : edges.all) {
        meet(edge.a, edge.b, edge.boundary());
        meet(edge.b, edge.a, edge.boundary());
    }
    return rings;
}

/// Loop's weight of a neighbour, in the simpler form of Warren (1995).
float weight(std::uint32_t neighbours) {
    return neighbours == 3 ? 3.0f / 16 : 3.0f / (8 * float(std::max(neighbours, 1u)));
}

/// `inner` of each neighbour inside, `border` of each of two along a boundary; corners stay.
Vec3 smoothed(Vec3 p, const Ring& ring, float inner, float border) {
    if (ring.boundaries == 0) return p * (1 - float(ring.neighbours) * inner) + ring.sum * inner;
    if (ring.boundaries == 2) return p * (1 - 2 * border) + ring.boundary_sum * border;
    return p;
}

Mesh refined(const Mesh& mesh) {
    Edges edges(mesh);
    const auto rings = rings_of(mesh, edges);
    Mesh fine;
    fine.positions.reserve(mesh.positions.size() + edges.all.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        fine.positions.push_back(smoothed(mesh.positions[i], rings[i], weight(rings[i].neighbours), 1.0f / 8));
    for (Edge& edge : edges.all) {
        const Vec3 ends = mesh.positions[edge.a] + mesh.positions[edge.b];
        edge.middle = static_cast<std::uint32_t>(fine.positions.size());
        fine.positions.push_back(edge.boundary() ? ends * 0.5f : ends * (3.0f / 8) + edge.opposite * (1.0f / 8));
    }
    fine.triangles.reserve(mesh.triangles.size() * 4);
    for (const auto& t : mesh.triangles) {
        end_if_unwanted();
        const auto ab = edges.between(t[0], t[1]).middle, bc = edges.between(t[1], t[2]).middle,
                   ca = edges.between(t[2], t[0]).middle;
        fine.triangles.push_back({t[0], ab, ca});
        fine.triangles.push_back({ab, t[1], bc});
        fine.triangles.push_back({ca, bc, t[2]});
        fine.triangles.push_back({ab, bc, ca});
    }
    return fine;
}

void move_to_limit(Mesh& mesh) {
    const auto rings = rings_of(mesh, Edges(mesh));
    std::vector<Vec3> limit;
    limit.reserve(mesh.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const float n = float(rings[i].neighbours);
        limit.push_back(
            smoothed(mesh.positions[i], rings[i], 1 / (n + 3 / (8 * weight(rings[i].neighbours))), 1.0f / 5));
    }
    mesh.positions = std::move(limit);
}

void add_normals(Mesh& mesh) {
    mesh.normals.assign(mesh.positions.size(), {});
    for (const auto& t : mesh.triangles) {
        const Vec3 n = cross(mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]]);
        for (const auto i : t) mesh.normals[i] = mesh.normals[i] + n;  // larger faces count more
    }
}

}  // namespace

Mesh subdivide(const Mesh& control, int levels) {
    Mesh mesh;
    mesh.positions = control.positions;
    mesh.triangles = control.triangles;
    for (int i = 0; i < levels; ++i) mesh = refined(mesh);
    move_to_limit(mesh);
    add_normals(mesh);
    return mesh;
}

}  // namespace lightnet::pbrt
