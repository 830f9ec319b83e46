// A mesh of a million triangles or more, where nobody has to bring one.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/base/math/random.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet::bench {

/// Hills on hills, 20 units wide and some 8 high, y upwards. Always the same: 2 `side`² triangles.
inline Mesh landscape(std::uint32_t side = 722) {
    constexpr int octaves = 8;
    const auto random = [](std::uint64_t key) { return float(mix(key) >> 40) * 0x1p-24f; };
    Mesh mesh;
    for (std::uint32_t row = 0; row <= side; ++row)
        for (std::uint32_t column = 0; column <= side; ++column) {
            const float x = 20.0f * float(column) / float(side) - 10, z = 20.0f * float(row) / float(side) - 10;
            float height = 0, size = 2.2f, waves = 0.5f;
            for (std::uint64_t i = 0; i < octaves; ++i, size *= 0.5f, waves *= 2) {
                const float angle = 6.2831853f * random(3 * i), c = std::cos(angle), s = std::sin(angle);
                height += size * std::sin(waves * (c * x + s * z) + 6 * random(3 * i + 1)) *
                          std::sin(waves * (c * z - s * x) + 6 * random(3 * i + 2));
            }
            mesh.positions.push_back({x, height, z});
        }
    for (std::uint32_t row = 0; row < side; ++row)
        for (std::uint32_t column = 0; column < side; ++column) {
            const std::uint32_t corner = row * (side + 1) + column;
            mesh.triangles.push_back({corner, corner + side + 1, corner + 1});
            mesh.triangles.push_back({corner + 1, corner + side + 1, corner + side + 2});
        }
    return mesh;
}

}  // namespace lightnet::bench
