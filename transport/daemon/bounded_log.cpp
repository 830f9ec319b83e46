#include "transport/daemon/bounded_log.hpp"

#include <string>

namespace lightnet {

void BoundedLog::operator()(const LogEntry& entry) {
    const auto kind = kind_of_line(entry.text);
    auto& bounds = kind == "refuses a" || kind == "turns away" ? refusals_ : lines_;
    if (bounds.may_be_said(kind, std::chrono::steady_clock::now())) tell_(entry);
}

std::vector<LogEntry> BoundedLog::left_out(Time now) {
    std::vector<LogEntry> said;
    for (auto* bounds : {&lines_, &refusals_})
        for (const auto& [kind, count] : bounds->left_out(now))
            said.emplace_back(LogLevel::warning,
                              "… and " + std::to_string(count) + " more lines like '" + kind + " …'");
    return said;
}

}  // namespace lightnet
