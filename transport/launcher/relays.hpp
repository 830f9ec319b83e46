// Passes asks and replies on between hosts that can't call each other.
#pragma once

#include <chrono>
#include <functional>
#include <set>
#include <string>

#include "core/run/message/counters.hpp"
#include "transport/keys/mac.hpp"
#include "transport/lines/message_frame.hpp"
#include "transport/wire/packet.hpp"
#include "transport/wire/relay_address.hpp"

namespace lightnet {

/// Looks at the fixed header and at the sealed address only. What can't be passed on is not kept: its asker hears that
/// it must send it again. An ask that is passed on bears a tag that binds its reply to asker, answerer, bundle and run,
/// so that no other host can answer it. One thread's.
class Relays {
public:
    using Time = std::chrono::steady_clock::time_point;
    struct Handlers {
        std::function<bool(const std::string& host, Frames& frames, std::uint32_t place)>
            ask;                                                               // [address][header][body]
        std::function<bool(const RelayAddress& asker, Frames& frames)> reply;  // the same
        std::function<void(const std::string& host)> request_resend;
        std::function<void()> damaged;  // whose it was can't be told any more
    };
    Relays(Counters& counters, Handlers handlers) : counters_(counters), handlers_(std::move(handlers)) {}

    /// [address][header][body] from a host. An ask is addressed to its answerer, and from here on to whoever asked.
    void forward(const std::string& from, Frames& frames);
    void must_resend(const std::string& host) { to_resend_.insert(host); }
    bool waiting() const { return !to_resend_.empty(); }
    /// Tells those who must, but not too often.
    void request_resends(Time now);

private:
    std::string tag_text(const std::string& asker, const std::string& place, const std::string& answerer,
                         const packet::Header& header) const;

    const Mac mac_{};  // made for one run
    Counters& counters_;
    Handlers handlers_;
    std::set<std::string> to_resend_;
    Time next_request_{};
};

}  // namespace lightnet
