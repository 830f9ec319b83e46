#include "core/math/sobol.hpp"

#include <array>

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

constexpr std::uint32_t owen_scramble(std::uint32_t x, std::uint32_t seed) {
    return reverse_bits(laine_karras(reverse_bits(x), seed));
}

// The second dimension of Sobol': direction numbers of the polynomial x + 1, one table per byte of the index.
constexpr auto second_dimension = [] {
    std::array<std::array<std::uint32_t, 256>, 4> table{};
    std::array<std::uint32_t, 32> direction{};
    direction[0] = 0x80000000u;
    for (std::size_t bit = 1; bit < 32; ++bit) direction[bit] = direction[bit - 1] ^ (direction[bit - 1] >> 1);
    for (std::size_t byte = 0; byte < 4; ++byte)
        for (std::size_t value = 0; value < 256; ++value)
            for (std::size_t bit = 0; bit < 8; ++bit)
                if (value >> bit & 1) table[byte][value] ^= direction[byte * 8 + bit];
    return table;
}();

struct Seeds {
    std::uint32_t order, first, second;
};

constexpr Seeds seeds_of(Key key) {
    const std::uint64_t other = mix(key + 0x9e3779b97f4a7c15ull);
    return {static_cast<std::uint32_t>(key), static_cast<std::uint32_t>(other),
            static_cast<std::uint32_t>(other >> 32)};
}

// The first dimension is the index with its bits reversed, so its scramble starts without a reversal.
constexpr std::uint32_t first_dimension(std::uint32_t shuffled, std::uint32_t seed) {
    return reverse_bits(laine_karras(shuffled, seed));
}

constexpr float to_unit(std::uint32_t x) { return static_cast<float>(x >> 8) * 0x1p-24f; }

}  // namespace

Vec2 sobol_point(Key key, std::uint32_t index) {
    const Seeds seeds = seeds_of(key);
    const std::uint32_t i = owen_scramble(index, seeds.order);
    const std::uint32_t second = second_dimension[0][i & 255] ^ second_dimension[1][i >> 8 & 255] ^
                                 second_dimension[2][i >> 16 & 255] ^ second_dimension[3][i >> 24];
    return {to_unit(first_dimension(i, seeds.first)), to_unit(owen_scramble(second, seeds.second))};
}

float sobol_coordinate(Key key, std::uint32_t index) {
    const Seeds seeds = seeds_of(key);
    return to_unit(first_dimension(owen_scramble(index, seeds.order), seeds.first));
}

}  // namespace lightnet
