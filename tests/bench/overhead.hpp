// What the benchmark `overhead` measures, one function per group of figures. Each prints its lines.
#pragma once

#include "tests/bench/picture.hpp"

namespace lightnet::bench {

/// overhead.serial: a SerialRun beside a hand-written loop over the same nodes.
void measure_serial(const Picture& picture);
/// overhead.threads: two places in threads beside two independent serial runs of half of the tiles.
void measure_threads(const Picture& picture, const Registry& registry, const char* name = "overhead.threads");
/// overhead.network: two daemons of one place each beside the same.
void measure_network(const Picture& picture, const Registry& registry, const char* name = "overhead.network");

}  // namespace lightnet::bench
