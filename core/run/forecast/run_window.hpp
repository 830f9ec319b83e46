// A look at a run for about a second: who worked at what, as it was measured.
#pragma once

#include <limits>
#include <vector>

namespace lightnet {

/// Of one host.
struct HostWindow {
    bool there = true;         // it takes part
    double seconds = 0;        // how long it was looked at; 0: nothing is known of it
    double processor = 0;      // seconds that its process had, all threads together
    double own = 0;            // the share of its places' time that went into messages
    std::vector<double> busy;  // and into each node, by node, without those that it called: 0 to 1
};

/// A value.
struct RunWindow {
    std::vector<HostWindow> hosts;                                  // as in the layout
    std::vector<double> questions;                                  // by edge of RunCosts, asked by all hosts
    double blocks = 0;                                              // of usual tiles, that came
    double left = 1;                                                // of all blocks, that are still to come: 0 to 1
    double seconds_left = std::numeric_limits<double>::infinity();  // that the run may still take
};

}  // namespace lightnet
