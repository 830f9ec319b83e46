// How benchmarks measure and what they print.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <exception>
#include <functional>
#include <string>
#include <vector>

namespace lightnet::bench {

/// The middle one; of an even number, the upper of the two.
inline double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Seconds that `work` takes on the wall clock.
inline double seconds_of(const std::function<void()>& work) {
    const auto begun = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
}

/// Seconds that this thread has computed: what others do on the machine does not count.
inline double thread_seconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// The middle, least and greatest of some ratios, for those who read along.
inline void show(const char* name, const std::vector<double>& ratios) {
    std::printf("  %s: median %.4f, least %.4f, greatest %.4f of %zu\n", name, median(ratios),
                *std::min_element(ratios.begin(), ratios.end()), *std::max_element(ratios.begin(), ratios.end()),
                ratios.size());
}

/// The line that `./bench` collects. `value` and `goal` are percentages; `at_least`: more is better.
inline void figure(const char* name, double value, double goal, bool at_least) {
    const bool met = at_least ? value >= goal : value <= goal;
    std::printf("%s %.*f%% %s%g%% %s\n", name, value < 0.1 ? 2 : 1, 100 * value, at_least ? ">=" : "<=", 100 * goal,
                met ? "ok" : "short");
    std::fflush(stdout);
}

/// The same for a quantity that is no percentage.
inline void quantity(const char* name, double value, const char* unit, double goal, bool at_least) {
    const bool met = at_least ? value >= goal : value <= goal;
    std::printf("%s %.1f %s%g (%s) %s\n", name, value, at_least ? ">=" : "<=", goal, unit, met ? "ok" : "short");
    std::fflush(stdout);
}

/// What main() does and returns: what goes wrong is said, with the benchmark's name.
inline int run(const char* name, const std::function<void()>& work) {
    try {
        work();
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s: %s\n", name, error.what());
        return 1;
    }
}

}  // namespace lightnet::bench
