// Progress of preparing, for display.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "core/run/assembly/activity.hpp"

namespace lightnet {

/// A value. Nodes prepare in several steps, whose number nobody knows beforehand.
struct PrepareProgress {
    std::string node;                     // that prepares; "": none
    std::size_t position = 0, nodes = 0;  // it is the first, second, … of those that prepare
    std::uint64_t done = 0, total = 0;    // parts of the step at which it is; 0 of 0: not known
    std::string what = {};                // it does, as it says itself
    friend bool operator==(const PrepareProgress&, const PrepareProgress&) = default;
};

/// With what the node says itself.
inline PrepareProgress with(PrepareProgress progress, const Doings& doings) {
    const auto found = doings.find(progress.node);
    if (found == doings.end()) return progress;
    progress.what = found->second.what;
    if (found->second.total) progress.done = found->second.done, progress.total = found->second.total;
    return progress;
}

/// "caustics 34/256"
inline std::string to_string(const PrepareProgress& progress) {
    if (!progress.total) return progress.node;
    return progress.node + " " + std::to_string(progress.done) + "/" + std::to_string(progress.total);
}

}  // namespace lightnet
