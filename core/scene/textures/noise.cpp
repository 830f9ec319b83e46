#include "core/scene/textures/noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace lightnet {
namespace {

// Perlin's permutation.
constexpr std::array<std::uint8_t, 256> permutation{
    151, 160, 137, 91,  90,  15,  131, 13,  201, 95,  96,  53,  194, 233, 7,   225, 140, 36,  103, 30,  69,  142,
    8,   99,  37,  240, 21,  10,  23,  190, 6,   148, 247, 120, 234, 75,  0,   26,  197, 62,  94,  252, 219, 203,
    117, 35,  11,  32,  57,  177, 33,  88,  237, 149, 56,  87,  174, 20,  125, 136, 171, 168, 68,  175, 74,  165,
    71,  134, 139, 48,  27,  166, 77,  146, 158, 231, 83,  111, 229, 122, 60,  211, 133, 230, 220, 105, 92,  41,
    55,  46,  245, 40,  244, 102, 143, 54,  65,  25,  63,  161, 1,   216, 80,  73,  209, 76,  132, 187, 208, 89,
    18,  169, 200, 196, 135, 130, 116, 188, 159, 86,  164, 100, 109, 198, 173, 186, 3,   64,  52,  217, 226, 250,
    124, 123, 5,   202, 38,  147, 118, 126, 255, 82,  85,  212, 207, 206, 59,  227, 47,  16,  58,  17,  182, 189,
    28,  42,  223, 183, 170, 213, 119, 248, 152, 2,   44,  154, 163, 70,  221, 153, 101, 155, 167, 43,  172, 9,
    129, 22,  39,  253, 19,  98,  108, 110, 79,  113, 224, 232, 178, 185, 112, 104, 218, 246, 97,  228, 251, 34,
    242, 193, 238, 210, 144, 12,  191, 179, 162, 241, 81,  51,  145, 235, 249, 14,  239, 107, 49,  192, 214, 31,
    181, 199, 106, 157, 184, 84,  204, 176, 115, 121, 50,  45,  127, 4,   150, 254, 138, 236, 205, 93,  222, 114,
    67,  29,  24,  72,  243, 141, 128, 195, 78,  66,  215, 61,  156, 180};

std::uint32_t permuted(std::uint32_t i) { return permutation[i & 255]; }

// The product with one of twelve directions, those to the middles of a cube's edges.
float slope(std::uint32_t x, std::uint32_t y, std::uint32_t z, Vec3 d) {
    const std::uint32_t h = permuted(permuted(permuted(x) + y) + z) & 15;
    const bool twice = h == 12 || h == 13;
    const float u = h < 8 || twice ? d.x : d.y, v = h < 4 || twice ? d.y : d.z;
    return (h & 1 ? -u : u) + (h & 2 ? -v : v);
}

float between(float t, float a, float b) { return a * (1 - t) + b * t; }

// From 0 to 1, with no slope or curvature at the ends.
float eased(float t) { return t * t * t * (t * (t * 6 - 15) + 10); }

struct Cell {
    std::uint32_t at;
    float within;
};
Cell cell_of(float x) {
    const float tame = std::isfinite(x) ? std::fmod(x, 0x1p30f) : 0, below = std::floor(tame);
    return {static_cast<std::uint32_t>(static_cast<std::int32_t>(below)), tame - below};
}

template <class Shape>
float octaves_of(Vec3 p, std::int32_t octaves, float roughness, Shape&& shape) {
    float sum = 0, frequency = 1, height = 1;
    for (std::int32_t i = 0; i < octaves; ++i) {
        sum += height * shape(noise(p * frequency));
        frequency *= 1.99f;
        height *= roughness;
    }
    return sum;
}

constexpr std::array<Rgb, 9> vein_colours{{{0.58f, 0.58f, 0.6f},
                                           {0.58f, 0.58f, 0.6f},
                                           {0.58f, 0.58f, 0.6f},
                                           {0.5f, 0.5f, 0.5f},
                                           {0.6f, 0.59f, 0.58f},
                                           {0.58f, 0.58f, 0.6f},
                                           {0.58f, 0.58f, 0.6f},
                                           {0.2f, 0.2f, 0.33f},
                                           {0.58f, 0.58f, 0.6f}}};

}  // namespace

float noise(Vec3 p) {
    const Cell x = cell_of(p.x), y = cell_of(p.y), z = cell_of(p.z);
    const float along = eased(x.within);
    const auto edge = [&](std::uint32_t j, std::uint32_t k) {
        const float below = y.within - float(j), behind = z.within - float(k);
        return between(along, slope(x.at, y.at + j, z.at + k, {x.within, below, behind}),
                       slope(x.at + 1, y.at + j, z.at + k, {x.within - 1, below, behind}));
    };
    const float up = eased(y.within);
    return between(eased(z.within), between(up, edge(0, 0), edge(1, 0)), between(up, edge(0, 1), edge(1, 1)));
}

float fractal_noise(Vec3 p, std::int32_t octaves, float roughness) {
    return octaves_of(p, octaves, roughness, [](float n) { return n; });
}

// The next octave, which is too fine to be seen, counts by its mean.
float turbulence(Vec3 p, std::int32_t octaves, float roughness) {
    return octaves_of(p, octaves, roughness, [](float n) { return std::fabs(n); }) +
           0.2f * std::pow(roughness, float(octaves));
}

float wind_waves(Vec3 p) { return std::fabs(fractal_noise(p * 0.1f, 3, 0.5f)) * fractal_noise(p, 6, 0.5f); }

bool in_dot(Vec2 at) {
    constexpr float radius = 0.35f, room = 0.5f - radius;
    const float x = std::floor(at.x + 0.5f), y = std::floor(at.y + 0.5f);
    const auto from = [&](float right, float up) { return noise({x + right, y + up, 0.5f}); };
    if (!(from(0.5f, 0.5f) > 0)) return false;
    const float aside = at.x - (x + room * from(1.5f, 2.8f)), above = at.y - (y + room * from(4.5f, 9.8f));
    return aside * aside + above * above < radius * radius;
}

// A curve of cubic pieces, each of which begins one colour later.
Rgb marble(Vec3 p, std::int32_t octaves, float roughness, float variation) {
    constexpr std::size_t pieces = vein_colours.size() - 3;
    const float vein = 0.5f + 0.5f * std::sin(p.y + variation * fractal_noise(p, octaves, roughness));
    const float along = std::isfinite(vein) ? vein * float(pieces) : 0;
    const std::size_t first = std::min(static_cast<std::size_t>(along), pieces - 1);
    const float t = along - float(first), s = 1 - t;
    const Rgb* c = &vein_colours[first];
    return (c[0] * (s * s * s) + c[1] * (3 * s * s * t) + c[2] * (3 * s * t * t) + c[3] * (t * t * t)) * 1.5f;
}

}  // namespace lightnet
