// What a run counts.
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace lightnet {

/// Counts of one place, or the sum over several.
struct Counters {
    std::uint64_t rays = 0;             // traced
    std::uint64_t local_questions = 0;  // answered by a call
    std::uint64_t questions = 0;        // sent to another place
    std::uint64_t bundles = 0;          // sent to another place
    std::uint64_t bytes = 0;            // sent and received over sockets between hosts
    std::uint64_t file_bytes = 0;       // of scene files, sent to hosts that did not have them
    std::uint64_t tiles = 0;            // rendered
    std::uint64_t asked_again = 0;      // bundles whose first place was lost
    std::uint64_t late_replies = 0;     // of bundles that were answered already; dropped
    std::uint64_t refused_sends = 0;    // at a full or broken socket; tried again
    std::uint64_t broken_packets = 0;   // dropped

    Counters& operator+=(const Counters& more) {
        rays += more.rays, local_questions += more.local_questions, questions += more.questions;
        bundles += more.bundles, bytes += more.bytes, file_bytes += more.file_bytes, tiles += more.tiles,
            asked_again += more.asked_again;
        late_replies += more.late_replies, refused_sends += more.refused_sends, broken_packets += more.broken_packets;
        return *this;
    }
    std::map<std::string, std::uint64_t> named() const {
        return {{"rays", rays},
                {"local_questions", local_questions},
                {"questions", questions},
                {"bundles", bundles},
                {"bytes", bytes},
                {"file_bytes", file_bytes},
                {"tiles", tiles},
                {"asked_again", asked_again},
                {"late_replies", late_replies},
                {"refused_sends", refused_sends},
                {"broken_packets", broken_packets}};
    }
    friend bool operator==(const Counters&, const Counters&) = default;
};

}  // namespace lightnet
