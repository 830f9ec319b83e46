// Passes asks and replies on between hosts that can't call each other.
#pragma once

#include <chrono>
#include <functional>
#include <set>
#include <string>

#include "core/run/message/counters.hpp"
#include "transport/wire/relay_address.hpp"
#include "transport/zmq/sockets.hpp"

namespace lightnet {

/// Looks at the fixed header and at the sealed address only. What can't be passed on is not kept: its asker hears that
/// it must say it again. One thread's.
class Relays {
public:
    using Time = std::chrono::steady_clock::time_point;
    struct Ways {
        std::function<bool(const std::string& host, Frames& frames, std::uint32_t place)>
            ask;                                                               // [address][header][body]
        std::function<bool(const RelayAddress& asker, Frames& frames)> reply;  // the same
        std::function<void(const std::string& host)> say_again;
        std::function<void()> damaged;  // whose it was can't be told any more
    };
    Relays(Counters& counters, Ways ways) : counters_(counters), ways_(std::move(ways)) {}

    /// [address][header][body] from a host. An ask is addressed to its answerer, and from here on to whoever asked.
    void pass_on(const std::string& from, Frames& frames);
    void must_say_again(const std::string& host) { to_say_again_.insert(host); }
    bool waiting() const { return !to_say_again_.empty(); }
    void say_again(Time now);

private:
    Counters& counters_;
    Ways ways_;
    std::set<std::string> to_say_again_;
    Time next_again_{};
};

}  // namespace lightnet
