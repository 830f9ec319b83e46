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
    std::uint64_t prepared_bytes = 0;   // results of preparing that copies of nodes were given
    std::uint64_t tiles = 0;            // rendered
    std::uint64_t merged = 0;           // bundles that were answered together with one before them
    std::uint64_t cut_bundles = 0;      // cut up, so that several places share them
    std::uint64_t spilled = 0;         // bundles and tiles that did not go to the place of their region, as it was busy
    std::uint64_t asked_again = 0;     // bundles and tiles whose place was lost
    std::uint64_t overdue = 0;         // asked again elsewhere, as a place that is not lost kept silent
    std::uint64_t retried = 0;         // bundles and tiles that failed at one host, and were asked of another
    std::uint64_t doubled = 0;         // done once more at the end, by places with nothing else to do
    std::uint64_t compared = 0;        // answers that came twice and were compared bit for bit
    std::uint64_t set_aside = 0;       // bundles and tiles that seem to kill hosts
    std::uint64_t cancelled = 0;       // asks of lost places, dropped before they were answered
    std::uint64_t late_replies = 0;    // of bundles that were answered already; dropped
    std::uint64_t refused_sends = 0;   // at a full line; tried again. 0, as credit leaves room
    std::uint64_t broken_packets = 0;  // dropped
    std::map<std::string, std::uint64_t> not_finite;  // answers that were infinite or no numbers, by node

    Counters& operator+=(const Counters& more) {
        for (const auto& [name, count] : all) this->*count += more.*count;
        for (const auto& [node, count] : more.not_finite) not_finite[node] += count;
        return *this;
    }
    std::map<std::string, std::uint64_t> named() const {
        std::map<std::string, std::uint64_t> counts;
        for (const auto& [name, count] : all) counts[name] = this->*count;
        for (const auto& [node, count] : not_finite) counts[not_finite_of + node] = count;
        return counts;
    }
    /// From what named() gave; other names are left out.
    static Counters from(const std::map<std::string, std::uint64_t>& named) {
        Counters counters;
        for (const auto& [name, count] : all)
            if (const auto found = named.find(name); found != named.end()) counters.*count = found->second;
        for (const auto& [name, count] : named)
            if (name.starts_with(not_finite_of)) counters.not_finite[name.substr(not_finite_of.size())] = count;
        return counters;
    }

    /// Stands before the name of a node.
    static inline const std::string not_finite_of = "not_finite.";

    /// Every other count and its name, as in x.run.json and on the wire.
    static const std::array<std::pair<const char*, std::uint64_t Counters::*>, 22> all;
    friend bool operator==(const Counters&, const Counters&) = default;
};

inline constexpr std::array<std::pair<const char*, std::uint64_t Counters::*>, 22> Counters::all{{
    {"rays", &Counters::rays},
    {"local_questions", &Counters::local_questions},
    {"questions", &Counters::questions},
    {"bundles", &Counters::bundles},
    {"bytes", &Counters::bytes},
    {"relayed_bytes", &Counters::relayed_bytes},
    {"file_bytes", &Counters::file_bytes},
    {"prepared_bytes", &Counters::prepared_bytes},
    {"tiles", &Counters::tiles},
    {"merged", &Counters::merged},
    {"cut_bundles", &Counters::cut_bundles},
    {"spilled", &Counters::spilled},
    {"asked_again", &Counters::asked_again},
    {"overdue", &Counters::overdue},
    {"retried", &Counters::retried},
    {"doubled", &Counters::doubled},
    {"compared", &Counters::compared},
    {"set_aside", &Counters::set_aside},
    {"cancelled", &Counters::cancelled},
    {"late_replies", &Counters::late_replies},
    {"refused_sends", &Counters::refused_sends},
    {"broken_packets", &Counters::broken_packets},
}};

}  // namespace lightnet
