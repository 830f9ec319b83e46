#include "tools/support/log_line.hpp"

#include <fmt/format.h>

#include <array>
#include <ctime>

#include "core/base/hash.hpp"
#include "core/base/json_tree.hpp"
#include "core/base/printable.hpp"

namespace lightnet {

std::string log_line(const std::string& program, const std::string& text, std::chrono::system_clock::time_point when) {
    const std::time_t seconds = std::chrono::system_clock::to_time_t(when);
    std::tm parts{};
    localtime_r(&seconds, &parts);
    std::array<char, 64> time{};
    std::strftime(time.data(), time.size(), "%FT%T%z ", &parts);
    return time.data() + program + ": " + text;
}

std::string log_time(std::chrono::system_clock::time_point when) {
    const auto all = std::chrono::duration_cast<std::chrono::milliseconds>(when.time_since_epoch()).count();
    const auto seconds = static_cast<std::time_t>(all / 1000);
    std::tm parts{};
    gmtime_r(&seconds, &parts);
    std::array<char, 64> time{};
    std::strftime(time.data(), time.size(), "%FT%T", &parts);
    return fmt::format("{}.{:03}Z", time.data(), all % 1000);
}

std::string log_level(LogLevel level) {
    return level == LogLevel::info ? "info" : level == LogLevel::warning ? "warning" : "error";
}

std::string public_name_of_run(std::uint64_t run) {
    return to_hex(content_hash("run " + std::to_string(run))).substr(0, 8);
}

std::string log_json(const std::string& program, const std::string& host, const LogEntry& entry,
                     std::chrono::system_clock::time_point when) {
    JsonTree line{{"format", "lightnet log 1"},
                  {"time", log_time(when)},
                  {"level", log_level(entry.level)},
                  {"program", program},
                  {"host", host}};
    if (entry.run) line["run"] = public_name_of_run(*entry.run);
    line["text"] = in_utf8(entry.text);
    return to_text(line);
}

}  // namespace lightnet
