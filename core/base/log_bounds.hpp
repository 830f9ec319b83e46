// Bounds for log lines that anybody can cause.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace lightnet {

/// A bucket of tokens for each kind of line: a few may come at once, and then so many in a minute; what is left out is
/// counted, and told later. A pure state machine: time is an argument.
class LogBounds {
public:
    using Time = std::chrono::steady_clock::time_point;

    explicit LogBounds(double per_minute) : per_minute_(per_minute) {}

    /// Of a line of this kind.
    bool may_be_said(const std::string& kind, Time now);
    /// Kinds of which some were left out for a minute, with how many. They are counted anew from here on.
    std::vector<std::pair<std::string, std::uint64_t>> left_out(Time now);

private:
    struct Bucket {
        double tokens;
        Time filled;
        std::uint64_t left_out = 0;
        Time since{};  // the first of them
    };
    static constexpr std::size_t most_kinds = 64;  // further ones are one kind
    double per_minute_;
    std::map<std::string, Bucket> buckets_;
};

/// Of a line whose beginning is its own: its first two words.
std::string kind_of_line(const std::string& text);

}  // namespace lightnet
