// The size from which a bundle is full.
#pragma once

#include <algorithm>
#include <cstddef>

namespace lightnet {

/// Questions that go together, at most `most`. Costly ones are fewer: what takes long anyway loses nothing by another
/// message or call, large pieces of work are dealt out badly among replicas, and the first of them waits for the last.
/// `each`: seconds of work; 0: not known.
// DECISIONS: full-by-work
inline std::size_t full_bundle(std::size_t most, double each) {
    constexpr double enough_work = 0.01;  // seconds
    if (each <= 0) return most;
    return std::clamp<std::size_t>(static_cast<std::size_t>(std::min(enough_work / each, 1e9)), 1, most);
}

}  // namespace lightnet
