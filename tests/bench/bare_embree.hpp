// How much of a rendering is tracing rays: a whole serial render beside a bare loop over Embree that traces the same
// packets of rays, in the same order.
//
// The bare loop does nothing else: its packets are ready, as Embree wants them, where the processor's cache holds them.
// For that the recording is played in blocks of 256 KiB, each copied to one place before the clock starts, and traced
// there. What a program needs to make rays and to use hits costs the bare loop nothing.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/network/graph/kind.hpp"

namespace lightnet::bench {

struct BesideEmbree {
    double rays = 0;                                            // of one render
    std::vector<double> shares;                                 // of the bare loop's rate, round by round
    std::vector<double> whole_rates, bare_rates, single_rates;  // M rays per second of work; the last one ray by ray
};

/// Prepares and renders one of graphs/, with constants, on this thread. None: Embree is of a version whose functions
/// can't be stood in for.
std::optional<BesideEmbree> beside_bare_embree(const Registry& registry, const std::string& graph,
                                               const std::map<std::string, std::string>& constants, std::size_t rounds);

}  // namespace lightnet::bench
