// The test oracle: one thread, yet every ask is packed, parked and unpacked.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "core/run/assembly/assembly.hpp"
#include "core/run/place/place.hpp"

namespace lightnet {

/// Renders tiles like SerialRun, but through everything that a networked run goes through except sockets and threads:
/// each ask becomes a bundle, a packet, a fiber and a packet again. If its pixels differ from those of SerialRun, codec
/// or fibers are wrong. For tests.
Counters run_oracle(const std::shared_ptr<const Network>& network, const std::vector<Tile>& tiles, Tuning rules,
                    const std::function<void(const Tile&, std::span<const Rgb>)>& done);

}  // namespace lightnet
