// The exponential function and its kin, without branches: loops over many numbers become vectors, with the same bits as
// one number alone.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace lightnet {

/// e^x, to some 2e-7 of itself, for x between -87 and 88; beyond them it stays as it is there. After Cephes (Moshier),
/// expf.
[[gnu::always_inline]] inline float exponential(float x) {
    constexpr float least = -87, most = 88, per_two = 1.44269504f;
    constexpr float two_high = 0.693359375f, two_low = -2.12194440e-4f;  // ln 2, in two parts
    const float above = x > least ? x : least, within = above < most ? above : most;
    // Rounded by adding a number beside which no fraction fits: where a loop has conditions, compilers make no vectors
    // of conversions to integers.
    constexpr float rounder = 0x1.8p23f;
    const float shifted = within * per_two + rounder, whole = shifted - rounder;
    const std::int32_t power = std::bit_cast<std::int32_t>(shifted) - std::bit_cast<std::int32_t>(rounder);
    const float rest = within - whole * two_high - whole * two_low;
    const float tail =
        ((((1.9875691500e-4f * rest + 1.3981999507e-3f) * rest + 8.3334519073e-3f) * rest + 4.1665795894e-2f) * rest +
         1.6666665459e-1f) *
            rest +
        5.0000001201e-1f;
    return (tail * rest * rest + rest + 1) * std::bit_cast<float>((power + 127) << 23);
}

/// Natural logarithm of a normal number above 0, to some 1e-7. After Cephes, logf.
[[gnu::always_inline]] inline float logarithm(float x) {
    constexpr float two_high = 0.693359375f, two_low = -2.12194440e-4f, half_root = 0.707106781f;
    const auto bits = std::bit_cast<std::int32_t>(x);
    const float mantissa = std::bit_cast<float>((bits & 0x7fffff) | 0x3f000000);  // 0.5 … 1
    const bool low = mantissa < half_root;
    const float power = static_cast<float>((bits >> 23) - 126) - (low ? 1.0f : 0.0f);
    const float rest = (low ? mantissa + mantissa : mantissa) - 1, square = rest * rest;
    float sum = 7.0376836292e-2f;
    sum = sum * rest - 1.1514610310e-1f;
    sum = sum * rest + 1.1676998740e-1f;
    sum = sum * rest - 1.2420140846e-1f;
    sum = sum * rest + 1.4249322787e-1f;
    sum = sum * rest - 1.6668057665e-1f;
    sum = sum * rest + 2.0000714765e-1f;
    sum = sum * rest - 2.4999993993e-1f;
    sum = sum * rest + 3.3333331174e-1f;
    return rest + (sum * rest * square + power * two_low - 0.5f * square) + power * two_high;
}

/// 1 - erf(x) for x ≥ 0, to some 2e-6 of itself while that is above 1e-6. Press et al. 1992, "Numerical Recipes", §6.2.
[[gnu::always_inline]] inline float complementary_error(float x) {
    const float t = 1 / (1 + 0.5f * x);
    float sum = 0.17087277f;
    sum = sum * t - 0.82215223f;
    sum = sum * t + 1.48851587f;
    sum = sum * t - 1.13520398f;
    sum = sum * t + 0.27886807f;
    sum = sum * t - 0.18628806f;
    sum = sum * t + 0.09678418f;
    sum = sum * t + 0.37409196f;
    sum = sum * t + 1.00002368f;
    sum = sum * t - 1.26551223f;
    return t * exponential(sum - x * x);
}

/// x with erf(x) = y, for y between -1 and 1. Giles 2012, "Approximating the erfinv Function", single precision.
[[gnu::always_inline]] inline float inverse_error(float y) {
    const float w = -logarithm((1 - y) * (1 + y));
    const bool tail = w >= 5;
    const float root = std::sqrt(w > 0 ? w : 0), at = tail ? root - 3 : w - 2.5f;
    float sum = tail ? -0.000200214257f : 2.81022636e-08f;
    sum = sum * at + (tail ? 0.000100950558f : 3.43273939e-07f);
    sum = sum * at + (tail ? 0.00134934322f : -3.5233877e-06f);
    sum = sum * at + (tail ? -0.00367342844f : -4.39150654e-06f);
    sum = sum * at + (tail ? 0.00573950773f : 0.00021858087f);
    sum = sum * at + (tail ? -0.0076224613f : -0.00125372503f);
    sum = sum * at + (tail ? 0.00943887047f : -0.00417768164f);
    sum = sum * at + (tail ? 1.00167406f : 0.246640727f);
    sum = sum * at + (tail ? 2.83297682f : 1.50140941f);
    return y * sum;
}

}  // namespace lightnet
