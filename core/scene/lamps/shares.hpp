// Choosing one of many in proportion to what they weigh, by their cumulative distribution (CDF).
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace lightnet {

/// Writes the running sums of `parts`, so scaled that the last is 1, and returns their true total. All that weigh
/// nothing together weigh the same. Nothing is negative.
inline double running_shares(std::span<const double> parts, std::span<float> ends) {
    double total = 0, sum = 0;
    for (const double part : parts) total += part;
    const double even = 1.0 / double(std::max<std::size_t>(1, parts.size()));
    for (std::size_t i = 0; i < parts.size(); ++i) ends[i] = float(sum += total > 0 ? parts[i] / total : even);
    if (!ends.empty()) ends.back() = 1;
    return total;
}
inline double running_shares(const std::vector<double>& parts, std::vector<float>& ends) {
    ends.resize(parts.size());
    return running_shares(std::span(parts), std::span(ends));
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

}  // namespace lightnet
