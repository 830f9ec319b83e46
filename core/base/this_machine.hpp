// Where this process runs: for display, and for budgets. Nothing that is computed may depend on it.
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
/// From now on memory that is freed stays with this process, unless it is a piece of more than 4 MiB or more than 64
/// MiB are free: what tiles and bundles need, the next ones need again, and the system takes long to give it anew. To
/// be called once, at the start.
// DECISIONS: freed-memory-is-kept
void keep_freed_memory();
/// Names this process among those of a run, as long as it lives.
std::string process_name();

}  // namespace lightnet
