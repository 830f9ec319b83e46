#include "core/scene/geometry/quads.hpp"

#include <algorithm>
#include <iterator>
#include <optional>

namespace lightnet {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// Which corner of either triangle is not on the edge that they share.
struct Apart {
    std::uint32_t first, second;
};

// Only where both have the edge's corners in opposite order, as neighbours on one side of a surface do.
std::optional<Apart> share_an_edge(const Triangle& first, const Triangle& second) {
    for (std::uint32_t i = 0; i < 3; ++i)
        for (std::uint32_t k = 0; k < 3; ++k)
            if (first[(i + 1) % 3] == second[(k + 2) % 3] && first[(i + 2) % 3] == second[(k + 1) % 3])
                return Apart{i, k};
    return {};
}

// Weights of three corners, the first of which is the triangle's corner `turn`.
Vec2 turned_weights(const std::array<float, 3>& weights, std::uint32_t turn) {
    return {weights[(4 - turn) % 3], weights[(5 - turn) % 3]};
}

}  // namespace

Quads::Quads(const Mesh& mesh) {
    constexpr std::size_t remembered = 8;
    const auto& triangles = mesh.triangles;
    corners_.reserve(triangles.size() / 2 + triangles.size() / 16);
    pairs_.reserve(corners_.capacity());
    std::vector<std::uint32_t> unpaired;  // the latest last
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        const auto before = std::find_if(unpaired.rbegin(), unpaired.rend(),
                                         [&](std::uint32_t other) { return add_pair(mesh, other, t); });
        if (before != unpaired.rend()) {
            unpaired.erase(std::next(before).base());
            continue;
        }
        if (unpaired.size() == remembered) {
            add_alone(mesh, unpaired.front());
            unpaired.erase(unpaired.begin());
        }
        unpaired.push_back(t);
    }
    for (const std::uint32_t t : unpaired) add_alone(mesh, t);
}

bool Quads::add_pair(const Mesh& mesh, std::uint32_t first, std::uint32_t second) {
    constexpr std::uint32_t most_apart = (1u << 28) - 1;
    const Triangle &one = mesh.triangles[first], &other = mesh.triangles[second];
    const auto apart = share_an_edge(one, other);
    if (!apart || second - first > most_apart) return false;
    const auto [i, k] = *apart;
    corners_.push_back({one[i], one[(i + 1) % 3], other[k], one[(i + 2) % 3]});
    pairs_.push_back({first, second - first, i, k});
    return true;
}

void Quads::add_alone(const Mesh& mesh, std::uint32_t triangle) {
    const auto [a, b, c] = mesh.triangles[triangle];
    corners_.push_back({a, b, c, c});
    pairs_.push_back({triangle, 0, 0, 0});
}

TrianglePoint Quads::point(std::uint32_t quad, Vec2 at) const {
    const Pair& pair = pairs_[quad];
    if (!pair.step) return {pair.first, at};
    const float rest = 1 - at.x - at.y;
    if (rest >= 0) return {pair.first, turned_weights({rest, at.x, at.y}, pair.first_turn)};
    return {pair.first + pair.step, turned_weights({-rest, 1 - at.x, 1 - at.y}, pair.second_turn)};
}

std::size_t Quads::memory() const {
    return corners_.capacity() * sizeof(corners_[0]) + pairs_.capacity() * sizeof(Pair);
}

}  // namespace lightnet
