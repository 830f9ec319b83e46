// How benchmarks measure and what they print.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <functional>
#include <string>
#include <type_traits>
#include <vector>

namespace lightnet::bench {

/// Is this `./bench --smoke`? Then every row only has to come to its end, as small and as few times as it can, and no
/// goal is judged.
inline bool smoke() {
    static const bool asked = std::getenv("LIGHTNET_BENCH_SMOKE") != nullptr;
    return asked;
}
/// What is measured, or what is enough to see that it still can be.
template <class T>
T sized(T usual, std::type_identity_t<T> in_smoke) {
    return smoke() ? in_smoke : usual;
}
/// Where measurements are repeated so many times.
inline int repeated(int usual) { return sized(usual, 1); }

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

inline double seconds_on(clockid_t clock) {
    timespec now{};
    clock_gettime(clock, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Seconds that this thread, or all of this process, has computed: what others do on the machine does not count.
inline double thread_seconds() { return seconds_on(CLOCK_THREAD_CPUTIME_ID); }
inline double process_seconds() { return seconds_on(CLOCK_PROCESS_CPUTIME_ID); }

/// What was measured over and over, as it is printed: the middle one, and how far the others are from it.
struct Spread {
    double middle, least, greatest;
    std::size_t count;
    explicit Spread(const std::vector<double>& values)
        : middle(median(values)),
          least(*std::min_element(values.begin(), values.end())),
          greatest(*std::max_element(values.begin(), values.end())),
          count(values.size()) {}
};

/// What is no figure, for those who read along.
inline void show(const char* name, const std::vector<double>& values) {
    const Spread spread(values);
    std::printf("  %s: median %.4f, least %.4f, greatest %.4f of %zu\n", name, spread.middle, spread.least,
                spread.greatest, spread.count);
}

/// How a figure is written: values times `factor`, with so many digits behind the point.
struct Writing {
    const char* sign;  // directly behind the value and the goal
    const char* unit;  // in brackets at the end
    double factor = 1;
    int digits = 1;
};

/// The line that `./bench` collects: `NAME median [least greatest of count] goal ok|short`. `sound`: what was measured
/// is what was meant; nothing that isn't meets a goal.
inline void print_figure(const std::string& name, const std::vector<double>& values, const Writing& writing,
                         double goal, bool at_least, bool sound = true) {
    const Spread spread(values);
    if (smoke()) {
        std::printf("%s ran\n", name.c_str());
        std::fflush(stdout);
        return;
    }
    const bool met = sound && (at_least ? spread.middle >= goal : spread.middle <= goal);
    const auto number = [&](double value) {
        std::array<char, 64> text;
        std::snprintf(text.data(), text.size(), "%.*f", writing.digits, value * writing.factor);
        return std::string(text.data());
    };
    std::printf("%s %s%s [%s %s of %zu] %s%g%s %s%s\n", name.c_str(), number(spread.middle).c_str(), writing.sign,
                number(spread.least).c_str(), number(spread.greatest).c_str(), spread.count,
                at_least ? ">=" : "<=", goal * writing.factor, writing.sign, writing.unit, met ? "ok" : "short");
    std::fflush(stdout);
}

/// Of parts, printed as percentages. `at_least`: more is better.
inline void figure(const std::string& name, const std::vector<double>& values, double goal, bool at_least) {
    print_figure(name, values, {"%", "", 100, median(values) < 0.1 ? 2 : 1}, goal, at_least);
}

/// Of what is no percentage.
inline void quantity(const std::string& name, const std::vector<double>& values, const std::string& unit, double goal,
                     bool at_least) {
    print_figure(name, values, {"", ("(" + unit + ") ").c_str()}, goal, at_least);
}

/// A figure that can't be had here, though all is well: `./bench` counts these at its end.
inline void not_run(const std::string& name, const std::string& why) {
    std::printf("%s not run: %s\n", name.c_str(), why.c_str());
    std::fflush(stdout);
}

/// A figure that could not be had because something went wrong: an error of `./bench`.
inline void broken(const std::string& name, const std::string& why) {
    not_run(name, "it did not come to its end: " + why);
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
