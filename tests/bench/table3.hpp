// What the benchmark `table3` measures: two figures, of the paper's hosts.
#pragma once

#include <array>
#include <cstdint>

namespace lightnet::bench {

/// Processors of the paper's three hosts.
inline constexpr std::array<std::uint32_t, 3> table3_places{4, 2, 1};

/// Costs that are emulated by waiting: seven places, each as quick as the others.
void measure_emulated_hosts();
/// The real operators, on three daemons that may use parts of this machine's processors.
void measure_real_hosts();

}  // namespace lightnet::bench
