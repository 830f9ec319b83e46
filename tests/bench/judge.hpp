// How some benchmarks judge what they have seen: pure functions, so that each can be shown to say no.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace lightnet::bench {

/// Does the output of a program of GoogleTest say that one test ran, and passed? A filter that matches nothing passes
/// as well, and so does a test that is skipped.
inline bool one_test_passed(const std::string& output) {
    return output.find("] 1 test from 1 test suite ran.") != std::string::npos &&
           output.find("[  PASSED  ] 1 test.") != std::string::npos;
}

/// How much memory there was, and when.
struct MemorySample {
    double seconds = 0, bytes = 0;
};

/// How fast memory grows, bytes per second. What is taken for a moment and given back doesn't count: of each twelfth of
/// the time the least counts, and of all slopes between those the middle one (Theil 1950, Sen 1968), or the one that
/// `part` of them are below.
inline double growth(const std::vector<MemorySample>& samples, double part = 0.5) {
    constexpr std::size_t parts = 12;
    if (samples.size() < parts) return 0;
    std::vector<MemorySample> least;
    for (std::size_t i = 0; i < parts; ++i) {
        const auto begin = samples.begin() + static_cast<std::ptrdiff_t>(samples.size() * i / parts);
        const auto end = samples.begin() + static_cast<std::ptrdiff_t>(samples.size() * (i + 1) / parts);
        least.push_back(*std::min_element(begin, end, [](const auto& a, const auto& b) { return a.bytes < b.bytes; }));
    }
    std::vector<double> slopes;
    for (std::size_t i = 0; i < parts; ++i)
        for (std::size_t j = 0; j < i; ++j)
            slopes.push_back((least[i].bytes - least[j].bytes) / (least[i].seconds - least[j].seconds));
    const auto chosen = slopes.begin() + static_cast<std::ptrdiff_t>(static_cast<double>(slopes.size()) * part);
    std::nth_element(slopes.begin(), chosen, slopes.end());
    return *chosen;
}

/// By which place each value comes among the others, from 0; those that are alike share the mean of theirs.
inline std::vector<double> ranks_of(const std::vector<double>& values) {
    std::vector<double> ranks;
    for (const double value : values) {
        const auto less = std::count_if(values.begin(), values.end(), [&](double other) { return other < value; });
        const auto alike = std::count(values.begin(), values.end(), value);
        ranks.push_back(double(less) + double(alike - 1) / 2);
    }
    return ranks;
}

/// Spearman's: 1 where both are in the same order, -1 where the order is reversed; 0 where all of one are alike.
inline double rank_correlation(const std::vector<double>& one, const std::vector<double>& other) {
    const auto a = ranks_of(one), b = ranks_of(other);
    const double mean = (double(a.size()) - 1) / 2;
    double both = 0, of_a = 0, of_b = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        both += (a[i] - mean) * (b[i] - mean);
        of_a += (a[i] - mean) * (a[i] - mean), of_b += (b[i] - mean) * (b[i] - mean);
    }
    return of_a > 0 && of_b > 0 ? both / std::sqrt(of_a * of_b) : 0;
}

/// The value that `part` of all are not above.
inline double part_below(std::vector<double> values, double part) {
    std::sort(values.begin(), values.end());
    const auto count = static_cast<std::size_t>(std::ceil(part * double(values.size())));
    return values[std::clamp<std::size_t>(count, 1, values.size()) - 1];
}

}  // namespace lightnet::bench
