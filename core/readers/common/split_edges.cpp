#include "core/readers/common/split_edges.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/base/unwanted.hpp"

namespace lightnet {
namespace {

using Corners = std::array<std::uint32_t, 3>;

Vec3 unit_if_any(Vec3 v) {
    const float size = length(v);
    return size > 0 && std::isfinite(size) ? v / size : v;
}

class EdgeSplitter {
public:
    EdgeSplitter(Mesh& mesh, const Matrix& to_world, float longest)
        : mesh_(mesh), to_world_(to_world), longest_(longest) {}

    bool run(std::uint64_t most) {
        if (least_triangles() > double(most)) return false;
        std::vector<Corners> open(mesh_.triangles.rbegin(), mesh_.triangles.rend());
        mesh_.triangles.clear();
        for (; !open.empty(); end_if_unwanted()) {
            const Corners t = open.back();
            open.pop_back();
            const std::size_t edge = longest_of(t);
            if (!(length_of(t, edge) >= longest_)) {  // what is not finite is told later
                mesh_.triangles.push_back(t);
                continue;
            }
            if (mesh_.triangles.size() + open.size() + 2 > most) return false;
            const std::uint32_t a = t[edge], b = t[(edge + 1) % 3], c = t[(edge + 2) % 3], middle = between(a, b);
            open.push_back({middle, b, c});
            open.push_back({a, middle, c});
        }
        return true;
    }

private:
    /// No triangle of such edges is larger than one whose sides are alike.
    double least_triangles() const {
        const double largest = std::sqrt(3.0) / 4 * longest_ * double{longest_};
        double area = 0;
        for (const auto& t : mesh_.triangles) {
            const auto at = [&](std::size_t i) { return transform_point(to_world_, mesh_.positions[t[i]]); };
            area += 0.5 * double{length(cross(at(1) - at(0), at(2) - at(0)))};
        }
        return area / largest;
    }
    /// Of the edge that begins at that corner, in the world.
    float length_of(const Corners& t, std::size_t corner) const {
        const auto at = [&](std::size_t i) { return transform_point(to_world_, mesh_.positions[t[i % 3]]); };
        return length(at(corner + 1) - at(corner));
    }
    std::size_t longest_of(const Corners& t) const {
        const std::array sizes{length_of(t, 0), length_of(t, 1), length_of(t, 2)};
        return std::size_t(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
    }
    std::uint32_t between(std::uint32_t a, std::uint32_t b) {
        const std::uint64_t edge = std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
        const auto [known, fresh] = middles_.try_emplace(edge, static_cast<std::uint32_t>(mesh_.positions.size()));
        if (!fresh) return known->second;
        const auto half = [&](auto& values) {
            if (!values.empty()) values.push_back((values[a] + values[b]) * 0.5f);
        };
        half(mesh_.positions), half(mesh_.uvs), half(mesh_.colours);
        if (!mesh_.normals.empty()) mesh_.normals.push_back(unit_if_any(mesh_.normals[a] + mesh_.normals[b]));
        return known->second;
    }

    Mesh& mesh_;
    const Matrix& to_world_;
    float longest_;
    std::unordered_map<std::uint64_t, std::uint32_t> middles_;  // of edges, by both ends
};

}  // namespace

bool split_edges(Mesh& mesh, const Matrix& to_world, float longest, std::uint64_t most) {
    return EdgeSplitter(mesh, to_world, longest).run(most);
}

void normals_of_faces(Mesh& mesh) {
    mesh.normals.assign(mesh.positions.size(), Vec3{});
    for (const auto& t : mesh.triangles) {
        const Vec3 a = mesh.positions[t[0]];
        const Vec3 face = unit_if_any(cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a));
        for (const auto corner : t) mesh.normals[corner] += face;
    }
    for (Vec3& normal : mesh.normals) normal = unit_if_any(normal);
}

}  // namespace lightnet
