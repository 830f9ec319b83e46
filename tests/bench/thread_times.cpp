#include "tests/bench/thread_times.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

namespace lightnet::bench {
namespace {

std::string kind_of(std::string name) {
    const auto last = name.find_last_not_of("0123456789");
    name.erase(last == std::string::npos ? 0 : last + 1);
    while (!name.empty() && (name.back() == ' ' || name.back() == '/')) name.pop_back();
    return name;
}

// The 14th and the 15th word, of which the second is a name in parentheses that may be several.
double seconds_in(const std::string& stat) {
    constexpr int others = 11;
    std::istringstream words(stat.substr(std::min(stat.size(), stat.rfind(')') + 1)));
    std::string other;
    for (int i = 0; i < others; ++i) words >> other;
    double user = 0, system = 0;
    words >> user >> system;
    return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

}  // namespace

ThreadTimes thread_times(int process) {
    namespace fs = std::filesystem;
    ThreadTimes times;
    std::error_code gone;
    for (const auto& thread : fs::directory_iterator("/proc/" + std::to_string(process) + "/task", gone)) {
        std::string name, stat;
        std::getline(std::ifstream(thread.path() / "comm"), name);
        std::getline(std::ifstream(thread.path() / "stat"), stat);
        times[kind_of(name)] += seconds_in(stat);
    }
    return times;
}

ThreadTimes operator-(ThreadTimes after, const ThreadTimes& before) {
    for (const auto& [kind, seconds] : before) after[kind] -= seconds;
    return after;
}

std::string text_of(const ThreadTimes& times) {
    std::vector<std::pair<double, std::string_view>> most_first;
    for (const auto& [kind, seconds] : times) most_first.emplace_back(seconds, kind);
    std::sort(most_first.rbegin(), most_first.rend());
    std::string text;
    for (const auto& [seconds, kind] : most_first) {
        std::array<char, 16> number;
        std::snprintf(number.data(), number.size(), "%.2f", seconds);
        text += (text.empty() ? "" : ", ") + std::string(kind) + " " + number.data();
    }
    return text;
}

}  // namespace lightnet::bench
