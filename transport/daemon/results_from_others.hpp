// Results of preparing on their way from other hosts of a run.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <list>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/bytes.hpp"
#include "core/base/hash.hpp"
#include "transport/store/arriving_bytes.hpp"
#include "transport/wire/line_pace.hpp"
#include "transport/wire/packet.hpp"

namespace lightnet {

/// Asks hosts that have a result for it, in pieces, as many under way as the line takes; one host after another, two at
/// most. Who is lost, silent, far slower than a line should be, or gives what is not what its hash says, is left, and
/// but for the first not asked again in this run; the launcher has all results, too. A pure state machine: time is an
/// argument. One thread's. DECISIONS: from-the-nearest
class ResultsFromOthers {
public:
    using Time = LinePace::Time;
    struct Ask {
        std::string host;
        Hash hash;
        std::uint64_t offset = 0, size = 0;  // bytes
    };
    /// False: there is no way to that host.
    using Send = std::function<bool(const Ask&)>;
    struct Outcome {
        Hash hash;
        Bytes bytes;  // null: the launcher has to send it
    };
    /// Why a host was left.
    struct Trouble {
        std::string host, why;
    };

    /// `holders`: the nearest first.
    void want(const Hash& hash, std::uint64_t size, const std::vector<std::string>& holders);
    /// Asks for more, and leaves those who are too slow.
    void go_on(Time now, const Send& send);
    /// What a host gives; bytes that nobody waits for are dropped.
    void take(const std::string& from, const packet::Piece& piece, Time now);
    /// That host has it no more, or can't give it now.
    void lacks(const std::string& from, const Hash& hash);
    /// What was under way to a host and back.
    void lose(const std::string& host);
    bool waits() const { return !wanted_.empty(); }
    /// What has become of what was wanted, since the last call.
    std::vector<Outcome> outcomes() { return std::exchange(outcomes_, {}); }
    std::vector<Trouble> troubles() { return std::exchange(troubles_, {}); }

private:
    struct Wanted {
        Hash hash;
        std::uint64_t size;
        std::deque<std::string> holders;           // the first is asked
        std::optional<ArrivingResult> arriving{};  // since it was asked for
        std::uint64_t asked = 0;                   // bytes, from the beginning
        Time begun{}, heard{};
    };
    struct Holder {
        LinePace pace;
        bool left = false;
    };
    using Place = std::list<Wanted>::iterator;
    Place find(const std::string& from, const Hash& hash);
    bool ask(Wanted& wanted, Holder& holder, Time now, const Send& send) const;
    void ask_next(Wanted& wanted);
    void leave(Wanted& wanted, const std::string& why);
    std::string too_slow(const Wanted& wanted, Time now) const;

    std::list<Wanted> wanted_;
    std::map<std::string, Holder> holders_;
    std::vector<Outcome> outcomes_;
    std::vector<Trouble> troubles_;
};

}  // namespace lightnet
