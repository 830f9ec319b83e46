#include "tools/log_line.hpp"

#include <array>
#include <ctime>

namespace lightnet {

std::string log_line(const std::string& program, const std::string& text, std::chrono::system_clock::time_point when) {
    const std::time_t seconds = std::chrono::system_clock::to_time_t(when);
    std::tm parts{};
    localtime_r(&seconds, &parts);
    std::array<char, 64> time{};
    std::strftime(time.data(), time.size(), "%FT%T%z ", &parts);
    return time.data() + program + ": " + text;
}

}  // namespace lightnet
