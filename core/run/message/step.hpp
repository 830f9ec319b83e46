// Steps by which the launcher leads places through preparing: what it asks of them, and what they report.
#pragma once

#include <cstdint>
#include <string>
#include <type_traits>

#include "core/base/hash.hpp"

namespace lightnet {

/// The calls of a node's prepare() go by numbers that are never used again when it prepares for another pass.
inline constexpr std::uint32_t calls_per_pass = 1u << 12;
constexpr std::uint32_t first_call_of(std::uint32_t pass) { return pass * calls_per_pass; }
constexpr std::uint32_t pass_of_call(std::uint32_t call) { return call / calls_per_pass; }
constexpr bool is_first_call(std::uint32_t call) { return call % calls_per_pass == 0; }

/// One thing that a place is asked to do for a node. Travels as a question; bytes answer it.
struct Step {
    enum class Kind : std::uint32_t {
        prepare,  // begin prepare() for the pass of call `call`; answered by a StepReport when it first waits, or ends
        go_on,    // the result of call `call` is there: `data` names it. Answered by the next StepReport
        shards,   // do `count` shards of call `call`, from `first` on; answered by join_shards() of their results
        collect,  // answered by what the node has noted in the rehearsal that is call `call`; `first` is the asker's
        leave,    // others hold the node: what it has learnt is let go of. Answered when that is done
        attend,   // answered by LockWords as soon as there are some; `call` 1: by all that holds now, once more
        grant,    // the lock that `data` names belongs to this place until it says otherwise
        last = grant,
    };
    Kind kind = Kind::prepare;
    std::uint32_t call = 0;
    std::uint32_t first = 0, count = 0;
    Hash data{};
    friend bool operator==(const Step&, const Step&) = default;
};

/// Where a node's prepare() is at one place. On the wire, lines that the node says to the user follow it.
struct StepReport {
    enum class Kind : std::uint32_t {
        map,       // waits for the result of `count` shards
        sectors,   // the same for what lies in its sector alone: every shard gives a list for each sector
        rehearse,  // waits for the end of a rehearsal with stride `count`
        done,
        last = done,
    };
    Kind kind = Kind::done;
    std::uint32_t call = 0;
    std::uint32_t count = 0;
    friend bool operator==(const StepReport&, const StepReport&) = default;
};

/// "shard 4 of what a node prepares", of a step of shards.
inline std::string describe(const Step& step) {
    const auto last = step.first + step.count - 1;
    const auto which = step.count == 1 ? " " : "s " + std::to_string(step.first) + " to ";
    return "shard" + which + std::to_string(last) + " of what a node prepares";
}

static_assert(std::is_trivially_copyable_v<Step> && sizeof(Step) == 48);
static_assert(std::is_trivially_copyable_v<StepReport> && sizeof(StepReport) == 12);

}  // namespace lightnet
