// Eight numbers at once: the compiler's own vectors, for loops that it would make none of.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

// How vectors are handed over depends on the processor that is compiled for. Here nothing is: all is inlined.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace lightnet {

// In memory that is wider than a processor's vectors they need `alignas(64)`.
using Eight = float __attribute__((vector_size(32)));
using Mask = std::int32_t __attribute__((vector_size(32)));

[[gnu::always_inline]] inline Eight select(const Mask& mask, const Eight& a, const Eight& b) {
    return (Eight)((mask & (Mask)a) | (~mask & (Mask)b));
}
[[gnu::always_inline]] inline Eight greater_of(const Eight& a, const Eight& b) { return select(a > b, a, b); }
[[gnu::always_inline]] inline Eight lesser_of(const Eight& a, const Eight& b) { return select(a < b, a, b); }
[[gnu::always_inline]] inline Eight all_of(float x) { return Eight{x, x, x, x, x, x, x, x}; }
[[gnu::always_inline]] inline Mask all_of(std::int32_t x) { return Mask{x, x, x, x, x, x, x, x}; }
[[gnu::always_inline]] inline Eight magnitude(const Eight& a) { return (Eight)((Mask)a & 0x7fffffff); }
[[gnu::always_inline]] inline Eight root(const Eight& a) {
    Eight roots;
    for (std::uint32_t i = 0; i < 8; ++i) roots[i] = std::sqrt(a[i]);
    return roots;
}

/// Numbers that lie one after the other, anywhere.
[[gnu::always_inline]] inline Eight eight_at(const float* first) {
    Eight eight;
    std::memcpy(&eight, first, sizeof(eight));
    return eight;
}
[[gnu::always_inline]] inline void put(const Eight& eight, float* first) { std::memcpy(first, &eight, sizeof(eight)); }
/// In the same order for all widths.
[[gnu::always_inline]] inline float sum_of(const Eight& a) {
    return ((a[0] + a[4]) + (a[2] + a[6])) + ((a[1] + a[5]) + (a[3] + a[7]));
}
[[gnu::always_inline]] inline float greatest_of(const Eight& a) {
    float most = a[0];
    for (std::uint32_t i = 1; i < 8; ++i) most = a[i] > most ? a[i] : most;
    return most;
}

}  // namespace lightnet
