// How some benchmarks judge what they have seen: pure functions, so that each can be shown to say no.
#pragma once

#include <algorithm>
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

}  // namespace lightnet::bench
