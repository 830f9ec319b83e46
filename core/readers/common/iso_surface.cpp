#include "core/readers/common/iso_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "core/base/unwanted.hpp"

namespace lightnet {
namespace {

using Point = std::array<std::uint32_t, 3>;

// Corners of a cell by bits: 1 along x, 2 along y, 4 along z. Each tetrahedron goes from 0 to 7 by one axis after the
// other.
constexpr std::array<std::array<int, 4>, 6> tetrahedra{
    {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}}};

class IsoSurface {
public:
    explicit IsoSurface(const VolumeGrid& grid) : grid_(grid) {}

    std::optional<Mesh> run(std::uint64_t most) {
        const auto [nx, ny, nz] = grid_.size;
        for (std::uint32_t z = 0; z + 1 < nz; ++z, end_if_unwanted())
            for (std::uint32_t y = 0; y + 1 < ny; ++y)
                for (std::uint32_t x = 0; x + 1 < nx; ++x) {
                    cut_cell({x, y, z});
                    if (mesh_.triangles.size() > most) return std::nullopt;
                }
        return std::move(mesh_);
    }

private:
    float value(const Point& p) const {
        return grid_.values[(std::size_t{p[2]} * grid_.size[1] + p[1]) * grid_.size[0] + p[0]];
    }
    static Point corner(const Point& cell, int bits) {
        const auto bit = [&](int n) { return static_cast<std::uint32_t>(bits >> n & 1); };
        return {cell[0] + bit(0), cell[1] + bit(1), cell[2] + bit(2)};
    }

    void cut_cell(const Point& cell) {
        int inside = 0;
        for (int bits = 0; bits < 8; ++bits) inside += value(corner(cell, bits)) < 0;
        if (inside == 0 || inside == 8) return;
        for (const auto& corners : tetrahedra) cut(cell, corners);
    }

    // Which side a triangle's normal is on follows from that of its vertices, later.
    void cut(const Point& cell, const std::array<int, 4>& corners) {
        std::array<int, 4> in{}, out{};
        std::size_t ins = 0, outs = 0;
        for (const int bits : corners) (value(corner(cell, bits)) < 0 ? in[ins++] : out[outs++]) = bits;
        const auto between = [&](int a, int b) { return vertex(cell, std::min(a, b), std::max(a, b)); };
        if (ins == 1 || outs == 1) {
            const int alone = ins == 1 ? in[0] : out[0];
            const auto& others = ins == 1 ? out : in;
            add(between(alone, others[0]), between(alone, others[1]), between(alone, others[2]));
        } else if (ins == 2) {
            const std::uint32_t a = between(in[0], out[0]), b = between(in[0], out[1]), c = between(in[1], out[1]),
                                d = between(in[1], out[0]);
            add(a, b, c), add(a, c, d);
        }
    }
    void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        if (a != b && b != c && c != a) mesh_.triangles.push_back({a, b, c});
    }

    /// Where the numbers between two corners of a cell, the second of which has all axes of the first, are 0.
    std::uint32_t vertex(const Point& cell, int from, int to) {
        const Point a = corner(cell, from), b = corner(cell, to);
        const std::uint64_t at = (std::uint64_t{a[2]} * grid_.size[1] + a[1]) * grid_.size[0] + a[0];
        const auto [known, fresh] = vertices_.try_emplace(at * 8 + static_cast<std::uint64_t>(to - from),
                                                          static_cast<std::uint32_t>(mesh_.positions.size()));
        if (!fresh) return known->second;
        const float low = value(a), high = value(b), part = low / (low - high);
        mesh_.positions.push_back(place(a) * (1 - part) + place(b) * part);
        const Vec3 normal = gradient(a) * (1 - part) + gradient(b) * part;
        const float size = length(normal);
        mesh_.normals.push_back(size > 0 && std::isfinite(size) ? normal / size : Vec3{});
        return known->second;
    }
    Vec3 place(const Point& p) const {
        const auto along = [&](std::size_t axis) { return float(p[axis]) / float(grid_.size[axis] - 1); };
        return {along(0), along(1), along(2)};
    }
    /// By differences between neighbours, of which there is one at the border.
    Vec3 gradient(const Point& p) const {
        const auto along = [&](std::size_t axis) {
            Point before = p, behind = p;
            before[axis] -= p[axis] > 0, behind[axis] += p[axis] + 1 < grid_.size[axis];
            return (value(behind) - value(before)) * float(grid_.size[axis] - 1) / float(behind[axis] - before[axis]);
        };
        return {along(0), along(1), along(2)};
    }

    const VolumeGrid& grid_;
    Mesh mesh_;
    std::unordered_map<std::uint64_t, std::uint32_t> vertices_;  // by point and direction
};

}  // namespace

std::optional<Mesh> iso_surface(const VolumeGrid& grid, std::uint64_t most) { return IsoSurface(grid).run(most); }

}  // namespace lightnet
