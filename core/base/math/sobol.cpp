#include "core/base/math/sobol.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>

#include "core/base/math/columns.hpp"

namespace lightnet {
namespace {

constexpr std::uint32_t reverse_bits(std::uint32_t x) {
    x = __builtin_bswap32(x);
    x = ((x & 0x0f0f0f0fu) << 4) | ((x & 0xf0f0f0f0u) >> 4);
    x = ((x & 0x33333333u) << 2) | ((x & 0xccccccccu) >> 2);
    return ((x & 0x55555555u) << 1) | ((x & 0xaaaaaaaau) >> 1);
}

// Laine & Karras 2011, section 3.1, with the constants of Vegdahl 2021 (fewer correlations than the original ones).
constexpr std::uint32_t laine_karras(std::uint32_t x, std::uint32_t seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

// The second dimension of Sobol' with its bits reversed. Its matrix, of the polynomial x + 1, is Pascal's triangle
// modulo 2, so it is made of its own halves, and the halves of those. Ahmed 2024, "An Implementation Algorithm of 2D
// Sobol Sequence Fast, Elegant, and Compact".
constexpr std::uint32_t reversed_second_dimension(std::uint32_t x) {
    x ^= x >> 1 & 0x55555555u;
    x ^= x >> 2 & 0x33333333u;
    x ^= x >> 4 & 0x0f0f0f0fu;
    x ^= x >> 8 & 0x00ff00ffu;
    return x ^ x >> 16;
}

struct Seeds {
    std::uint32_t order, first, second;
};

constexpr Seeds seeds_of(Key key) {
    const std::uint64_t other = mix(key + 0x9e3779b97f4a7c15ull);
    return {static_cast<std::uint32_t>(key), static_cast<std::uint32_t>(other),
            static_cast<std::uint32_t>(other >> 32)};
}

constexpr float to_unit(std::uint32_t x) { return static_cast<float>(static_cast<std::int32_t>(x >> 8)) * 0x1p-24f; }

// DECISIONS: sobol-pairs
constexpr std::uint32_t shuffled(std::uint32_t index, std::uint32_t seed) {
    return reverse_bits(laine_karras(reverse_bits(index), seed));
}

// Both dimensions have their bits reversed before they are scrambled; the first one is the index, reversed.
constexpr float first_coordinate(std::uint32_t shuffled, std::uint32_t seed) {
    return to_unit(reverse_bits(laine_karras(shuffled, seed)));
}
constexpr float second_coordinate(std::uint32_t shuffled, std::uint32_t seed) {
    return to_unit(reverse_bits(laine_karras(reversed_second_dimension(shuffled), seed)));
}

constexpr std::size_t at_once = 64;

/// Keys and indices of some points, and where the points go.
struct Some {
    std::size_t count;
    const Key* keys;
    const std::uint32_t* indices;
};

// Loops without branches over columns, which the compiler turns into vectors of whatever width there is. Nothing in
// them rounds, so the numbers are the same ones.
struct SeedColumns {
    std::array<std::uint32_t, at_once> order, first, second;

    [[gnu::always_inline]] void fill(const Some& some, Key offset) {
        for (std::size_t i = 0; i < some.count; ++i) {
            const Seeds seeds = seeds_of(mix(some.keys[i] + offset));
            order[i] = seeds.order;
            first[i] = seeds.first;
            second[i] = seeds.second;
        }
    }
};

// DECISIONS: numbers-in-columns
[[gnu::always_inline]] inline void make_points(const Some& some, Key offset, Vec2* points) {
    SeedColumns seeds;
    seeds.fill(some, offset);
    for (std::size_t i = 0; i < some.count; ++i) {
        const std::uint32_t place = shuffled(some.indices[i], seeds.order[i]);
        points[i].x = first_coordinate(place, seeds.first[i]);
        points[i].y = second_coordinate(place, seeds.second[i]);
    }
}

[[gnu::always_inline]] inline void make_coordinates(const Some& some, Key offset, float* values) {
    SeedColumns seeds;
    seeds.fill(some, offset);
    for (std::size_t i = 0; i < some.count; ++i)
        values[i] = first_coordinate(shuffled(some.indices[i], seeds.order[i]), seeds.first[i]);
}

// Of vector_width(). Keys are of 64 bits, which only the last one multiplies in one go.
struct Makers {
    void (*points)(const Some&, Key offset, Vec2*);
    void (*coordinates)(const Some&, Key offset, float*);
};
#if defined(__x86_64__)
[[gnu::target("avx2")]] void make_points_avx2(const Some& some, Key offset, Vec2* points) {
    make_points(some, offset, points);
}
[[gnu::target("avx2")]] void make_coordinates_avx2(const Some& some, Key offset, float* values) {
    make_coordinates(some, offset, values);
}
[[gnu::target("avx2,avx512f,avx512vl,avx512dq")]] void make_points_avx512(const Some& some, Key offset, Vec2* points) {
    make_points(some, offset, points);
}
[[gnu::target("avx2,avx512f,avx512vl,avx512dq")]] void make_coordinates_avx512(const Some& some, Key offset,
                                                                               float* values) {
    make_coordinates(some, offset, values);
}
Makers widest_makers() {
    if (vector_width() == Width::avx512) return {make_points_avx512, make_coordinates_avx512};
    if (vector_width() == Width::avx2) return {make_points_avx2, make_coordinates_avx2};
    return {make_points, make_coordinates};
}
#else
Makers widest_makers() { return {make_points, make_coordinates}; }
#endif
const Makers& makers() {
    static const Makers found = widest_makers();
    return found;
}

}  // namespace

Vec2 sobol_point(Key key, std::uint32_t index) {
    const Seeds seeds = seeds_of(key);
    const std::uint32_t place = shuffled(index, seeds.order);
    return {first_coordinate(place, seeds.first), second_coordinate(place, seeds.second)};
}

float sobol_coordinate(Key key, std::uint32_t index) {
    const Seeds seeds = seeds_of(key);
    return first_coordinate(shuffled(index, seeds.order), seeds.first);
}

void sobol_points(std::span<const Key> keys, Key offset, std::span<const std::uint32_t> indices,
                  std::span<Vec2> points) {
    assert(keys.size() == indices.size() && keys.size() == points.size() && "each point has its key and its index");
    for (std::size_t first = 0; first < keys.size(); first += at_once) {
        const Some some{std::min(at_once, keys.size() - first), &keys[first], &indices[first]};
        makers().points(some, offset, &points[first]);
    }
}

void sobol_coordinates(std::span<const Key> keys, Key offset, std::span<const std::uint32_t> indices,
                       std::span<float> values) {
    assert(keys.size() == indices.size() && keys.size() == values.size() && "each number has its key and its index");
    for (std::size_t first = 0; first < keys.size(); first += at_once) {
        const Some some{std::min(at_once, keys.size() - first), &keys[first], &indices[first]};
        makers().coordinates(some, offset, &values[first]);
    }
}

}  // namespace lightnet
