// Choosing one of many in proportion to what they weigh, by their cumulative distribution (CDF).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lightnet {

/// Writes the running sums of `parts`, so scaled that the last is 1, and returns their true total. All that weigh
/// nothing together weigh the same. Nothing is negative.
inline double prefix_cdf(std::span<const double> parts, std::span<float> ends) {
    double total = 0, sum = 0;
    for (const double part : parts) total += part;
    const double even = 1.0 / double(std::max<std::size_t>(1, parts.size()));
    for (std::size_t i = 0; i < parts.size(); ++i) ends[i] = float(sum += total > 0 ? parts[i] / total : even);
    if (!ends.empty()) ends.back() = 1;
    return total;
}
inline double prefix_cdf(const std::vector<double>& parts, std::vector<float>& ends) {
    ends.resize(parts.size());
    return prefix_cdf(std::span(parts), std::span(ends));
}

/// The share of one, exactly as pick() finds it.
inline float share_of(std::span<const float> ends, std::size_t i) { return ends[i] - (i == 0 ? 0 : ends[i - 1]); }

/// Which part `u` falls into; `u` becomes the place within it, so that good numbers stay good.
inline std::size_t pick(std::span<const float> ends, float& u) {
    std::size_t at = 0;
    if (constexpr std::size_t few = 8; ends.size() <= few)
        for (std::size_t i = 0; i + 1 < ends.size(); ++i) at += ends[i] <= u;  // none of these steps can be foretold
    else
        at = std::size_t(std::upper_bound(ends.begin(), ends.end() - 1, u) - ends.begin());
    const float start = at == 0 ? 0 : ends[at - 1];
    u = std::clamp((u - start) / (ends[at] - start), 0.0f, 0x1.fffffep-1f);
    return at;
}

/// Marks that lead to one of many without a search among all: in starts[k] the least part that a number of the k-th
/// equal piece of [0,1) may fall into, one behind the last. The number of pieces is a power of two.
inline void mark(std::span<const float> ends, std::span<std::uint32_t> starts) {
    const std::size_t pieces = starts.size() - 1;
    std::uint32_t at = 0;
    for (std::size_t k = 0; k < pieces; ++k) {
        while (at + 1 < ends.size() && ends[at] <= float(k) / float(pieces)) ++at;
        starts[k] = at;
    }
    starts[pieces] = std::uint32_t(ends.size() - 1);
}

/// As pick() without marks, to the bit, `u` in [0,1). No step can be foretold, so there is none to be foretold wrong.
inline std::size_t pick(std::span<const float> ends, std::span<const std::uint32_t> starts, float& u) {
    const auto piece = std::size_t(u * float(starts.size() - 1));
    std::size_t at = starts[piece], left = starts[piece + 1] - at;
    for (; left > 0; left /= 2) {
        const std::size_t half = (left + 1) / 2;
        at += ends[at + half - 1] <= u ? half : 0;
    }
    const float start = at == 0 ? 0 : ends[at - 1];
    u = std::clamp((u - start) / (ends[at] - start), 0.0f, 0x1.fffffep-1f);
    return at;
}

}  // namespace lightnet
