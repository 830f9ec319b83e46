// Counters of a run.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/run/message/place_record.hpp"
#include "core/run/message/place_trace.hpp"

namespace lightnet {

/// Counts of one place, or the sum over several.
struct Counters {
    std::uint64_t rays = 0;             // traced
    std::uint64_t local_questions = 0;  // answered by a call
    std::uint64_t questions = 0;        // sent to another place
    std::uint64_t bundles = 0;          // sent to another place, or to another host for any of its places
    std::uint64_t dealt = 0;            // bundles and tiles that dispatchers of hosts gave to one of its places
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
    std::uint64_t verified = 0;        // answers that two hosts gave alike before one of them counted
    std::uint64_t set_aside = 0;       // bundles and tiles that seem to kill hosts
    std::uint64_t cancelled = 0;       // asks of lost places, dropped before they were answered
    std::uint64_t late_replies = 0;    // of bundles that were answered already; dropped
    std::uint64_t refused_sends = 0;   // at a full line; tried again. 0, as credit leaves room
    std::uint64_t broken_packets = 0;  // dropped
    std::map<std::string, std::uint64_t> not_finite;   // answers that were infinite or no numbers, by node
    std::map<std::string, std::uint64_t> off_surface;  // points that no surface is near, by the node that asked; black
    std::map<std::string, std::uint64_t> lost_rays;  // that can't be traced, by the node that would; they meet nothing
    std::map<std::string, std::uint64_t> unsound_questions;  // whose numbers are not finite, by the node asked; black

    std::vector<PlaceRecord> places;  // what each place did
    std::vector<PlaceTrace> traces;   // where runs are traced

    Counters& operator+=(const Counters& more) {
        for (const auto& [name, count] : all) this->*count += more.*count;
        for (const auto& [name, counts] : by_node)
            for (const auto& [node, count] : more.*counts) (this->*counts)[node] += count;
        places.insert(places.end(), more.places.begin(), more.places.end());
        traces.insert(traces.end(), more.traces.begin(), more.traces.end());
        return *this;
    }
    /// All but `places` and `traces`.
    std::map<std::string, std::uint64_t> named() const {
        std::map<std::string, std::uint64_t> counts;
        for (const auto& [name, count] : all) counts[name] = this->*count;
        for (const auto& [name, of_nodes] : by_node)
            for (const auto& [node, count] : this->*of_nodes) counts[name + ("." + node)] = count;
        return counts;
    }
    /// From what named() gave; other names are left out.
    static Counters from(const std::map<std::string, std::uint64_t>& named) {
        Counters counters;
        for (const auto& [name, count] : all)
            if (const auto found = named.find(name); found != named.end()) counters.*count = found->second;
        for (const auto& [name, count] : named)
            for (const auto& [kind, of_nodes] : by_node)
                if (const auto beginning = kind + std::string("."); name.starts_with(beginning))
                    (counters.*of_nodes)[name.substr(beginning.size())] = count;
        return counters;
    }

    /// Every count and its name, as in x.run.json and on the wire; with the name of a node behind it, and a dot between
    /// them, where each node has its own.
    static const std::array<std::pair<const char*, std::uint64_t Counters::*>, 24> all;
    static const std::array<std::pair<const char*, std::map<std::string, std::uint64_t> Counters::*>, 4> by_node;
    friend bool operator==(const Counters&, const Counters&) = default;
};

inline constexpr std::array<std::pair<const char*, std::uint64_t Counters::*>, 24> Counters::all{{
    {"rays", &Counters::rays},
    {"local_questions", &Counters::local_questions},
    {"questions", &Counters::questions},
    {"bundles", &Counters::bundles},
    {"dealt", &Counters::dealt},
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
    {"verified", &Counters::verified},
    {"set_aside", &Counters::set_aside},
    {"cancelled", &Counters::cancelled},
    {"late_replies", &Counters::late_replies},
    {"refused_sends", &Counters::refused_sends},
    {"broken_packets", &Counters::broken_packets},
}};
inline constexpr std::array<std::pair<const char*, std::map<std::string, std::uint64_t> Counters::*>, 4>
    Counters::by_node{{
        {"not_finite", &Counters::not_finite},
        {"off_surface", &Counters::off_surface},
        {"lost_rays", &Counters::lost_rays},
        {"unsound_questions", &Counters::unsound_questions},
    }};

}  // namespace lightnet
