// Log lines of programs that run for long.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "core/base/log_entry.hpp"

namespace lightnet {

/// "2026-11-23T14:05:09+0100 lightnetd: it is ready": when, in the time of this machine, who, what.
std::string log_line(const std::string& program, const std::string& text, std::chrono::system_clock::time_point when);

/// A line of JSON, as docs/schemas/log.schema.json has it. `host`: who speaks.
std::string log_json(const std::string& program, const std::string& host, const LogEntry& entry,
                     std::chrono::system_clock::time_point when);

/// By what logs of launcher and hosts, and the report, call a run: eight digits that tell it from others. Its number
/// itself is nothing for logs, as who knows it may speak to its hosts where they have no keys.
std::string public_name_of_run(std::uint64_t run);

/// "2026-11-23T13:05:09.123Z"
std::string log_time(std::chrono::system_clock::time_point when);
std::string log_level(LogLevel level);

}  // namespace lightnet
