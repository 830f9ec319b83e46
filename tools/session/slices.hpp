// Work in slices, between which somebody looks whether it is still wanted.
#pragma once

#include <algorithm>
#include <chrono>

namespace lightnet {

/// What a run does between two looks around.
struct Slices {
    static constexpr std::chrono::milliseconds now_and_then{50};  // looks around
    static constexpr std::chrono::milliseconds at_once{1};        // looks whether it is wanted, where that changes

    std::chrono::milliseconds slice = now_and_then;

    /// True: `work`, which is told how long it may take, says so. It ends early when `ended` does.
    template <class Work, class Ended>
    bool of(const Work& work, const Ended& ended) const {
        for (auto left = now_and_then; left.count() > 0 && !ended(); left -= slice)
            if (work(std::min(slice, left))) return true;
        return false;
    }
};

}  // namespace lightnet
