// What a run counts.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

namespace lightnet {

/// Counts of one place, or the sum over several.
struct Counters {
    std::uint64_t rays = 0;             // traced
    std::uint64_t local_questions = 0;  // answered by a call
    std::uint64_t questions = 0;        // sent to another place
    std::uint64_t bundles = 0;          // sent to another place
    std::uint64_t bytes = 0;            // sent and received over sockets between hosts
    std::uint64_t relayed_bytes = 0;    // passed on by the launcher between hosts that can't call each other
    std::uint64_t file_bytes = 0;       // of scene files, sent to hosts that did not have them
    std::uint64_t tiles = 0;            // rendered
    std::uint64_t asked_again = 0;      // bundles whose first place was lost
    std::uint64_t late_replies = 0;     // of bundles that were answered already; dropped
    std::uint64_t refused_sends = 0;    // at a full or broken socket; tried again
    std::uint64_t broken_packets = 0;   // dropped

    Counters& operator+=(const Counters& more) {
        for (const auto& [name, count] : all) this->*count += more.*count;
        return *this;
    }
    std::map<std::string, std::uint64_t> named() const {
        std::map<std::string, std::uint64_t> counts;
        for (const auto& [name, count] : all) counts[name] = this->*count;
        return counts;
    }

    /// Every count and its name, as in run.json and on the wire.
    static const std::array<std::pair<const char*, std::uint64_t Counters::*>, 12> all;
    friend bool operator==(const Counters&, const Counters&) = default;
};

inline constexpr std::array<std::pair<const char*, std::uint64_t Counters::*>, 12> Counters::all{{
    {"rays", &Counters::rays},
    {"local_questions", &Counters::local_questions},
    {"questions", &Counters::questions},
    {"bundles", &Counters::bundles},
    {"bytes", &Counters::bytes},
    {"relayed_bytes", &Counters::relayed_bytes},
    {"file_bytes", &Counters::file_bytes},
    {"tiles", &Counters::tiles},
    {"asked_again", &Counters::asked_again},
    {"late_replies", &Counters::late_replies},
    {"refused_sends", &Counters::refused_sends},
    {"broken_packets", &Counters::broken_packets},
}};

}  // namespace lightnet
