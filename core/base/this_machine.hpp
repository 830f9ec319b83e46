// This machine: for display, and for budgets. Nothing that is computed may depend on it.
#pragma once

#include <cstdint>
#include <string>

namespace lightnet {

/// As it calls itself.
std::string machine_name();
/// Bytes; 0: not known.
std::uint64_t machine_memory();
/// Of the machine's clock that only goes forward: to compare times of processes, of one machine or of several.
std::uint64_t steady_nanoseconds();
/// Names this process among those of a run, as long as it lives.
std::string process_name();

}  // namespace lightnet
