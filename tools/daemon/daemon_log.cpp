#include "tools/daemon/daemon_log.hpp"

#include <chrono>
#include <iostream>

#include "tools/support/log_line.hpp"

namespace lightnet {

void DaemonLog::operator()(const LogEntry& entry) const {
    const auto now = std::chrono::system_clock::now();
    std::cerr << (json_ ? log_json("lightnetd", host_, entry, now) : log_line("lightnetd", entry.text, now)) + "\n"
              << std::flush;
}

void DaemonLog::announce(const std::string& text) const {
    std::cout << (json_ ? log_json("lightnetd", host_, text, std::chrono::system_clock::now()) : text) + "\n"
              << std::flush;
}

void DaemonLog::give_up(const std::string& why) const {
    if (json_) return (*this)({LogLevel::error, why});
    std::cerr << why + "\n" << std::flush;
}

}  // namespace lightnet
