// What programs that run for long say to their log.
#pragma once

#include <chrono>
#include <string>

namespace lightnet {

/// "2026-11-23T14:05:09+0100 lightnetd: it is ready": when, in the time of this machine, who, what.
std::string log_line(const std::string& program, const std::string& text, std::chrono::system_clock::time_point when);

}  // namespace lightnet
