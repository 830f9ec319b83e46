// The history of a run, as far as a report keeps it.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

#include "tools/support/pace.hpp"

namespace lightnet {

/// States of a run, as text, from its beginning to its end. However long it takes, there are about as many: when they
/// are too many, every other one goes, and from then on half as many come.
class WatchHistory {
public:
    explicit WatchHistory(Pace::Clock::time_point now) : pace_(period_, now) {}

    bool due(Pace::Clock::time_point now) const { return pace_.due(now); }
    void add(const std::string& state, Pace::Clock::time_point now);
    const std::vector<std::string>& states() const { return states_; }

private:
    void halve();

    std::chrono::duration<double> period_{1};
    Pace pace_;
    std::vector<std::string> states_;
};

}  // namespace lightnet
