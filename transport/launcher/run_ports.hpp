// The ports of a daemon that serves several runs, each at one of them.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace lightnet {

/// Whoever is refused at one of them, as it is busy, calls the next; so does whoever gets no answer there. A value.
class RunPorts {
public:
    using Time = std::chrono::steady_clock::time_point;

    /// `ports`: as the refusal names them ("7000,7001"), the one that was called first. The one to be called next;
    /// none: all are busy, so there is time to wait.
    std::optional<std::uint16_t> next_after_refusal(const std::string& ports, Time now) {
        std::istringstream in(ports);
        ports_.clear();
        for (unsigned port = 0; in >> port; in.ignore()) ports_.push_back(static_cast<std::uint16_t>(port));
        if (++refused_ < ports_.size()) return next(now);
        refused_ = 0;
        return std::nullopt;
    }
    std::optional<std::uint16_t> next_if_silent(Time now) {
        if (!called_ || now - *called_ < patience || ports_.size() < 2) return std::nullopt;
        return next(now);
    }
    /// From now on an answer is waited for.
    void call(Time now) { called_ = now; }
    void answered() { called_.reset(); }
    bool calls() const { return called_.has_value(); }
    /// It serves us.
    void taken() { refused_ = 0; }

private:
    static constexpr auto patience = std::chrono::seconds(2);  // for an answer

    std::uint16_t next(Time now) {
        std::rotate(ports_.begin(), ports_.begin() + 1, ports_.end());
        call(now);
        return ports_.front();
    }

    std::vector<std::uint16_t> ports_;  // the one that is called first
    std::size_t refused_ = 0;           // in a row
    std::optional<Time> called_;
};

}  // namespace lightnet
