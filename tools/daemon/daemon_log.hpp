// The words of a daemon: where it listens, its log, and why it ends.
#pragma once

#include <string>

#include "core/base/log_entry.hpp"

namespace lightnet {

/// Lines of text, or lines of JSON, each written at once. Any thread.
class DaemonLog {
public:
    /// `host`: who speaks.
    DaemonLog(bool json, std::string host) : json_(json), host_(std::move(host)) {}

    /// An entry of the log, to the standard error.
    void operator()(const LogEntry& entry) const;
    /// Where it is to be found: to the standard output, for whoever waits for it.
    void announce(const std::string& text) const;
    /// Why it can't go on: to the standard error.
    void give_up(const std::string& why) const;

private:
    bool json_;
    std::string host_;
};

}  // namespace lightnet
