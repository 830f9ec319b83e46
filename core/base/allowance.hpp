// The part of the machine that this process may use: a container, Slurm and taskset give a part of it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace lightnet {

/// Where the system tells of limits; tests put their own files there.
struct SystemFiles {
    std::string proc = "/proc";
    std::string groups = "/sys/fs/cgroup";
};

/// How many cores, and who says so. A value.
struct CoreAllowance {
    unsigned machine = 1;           // that it has
    unsigned bound = 1;             // of them, to which the process is bound: taskset, a cpuset, Slurm
    std::optional<double> quota;    // of the control groups that it is in, the least; in cores
    std::optional<unsigned> asked;  // OMP_NUM_THREADS and OMP_THREAD_LIMIT, the less of the two
    /// At least 1; a part of a core counts as one.
    unsigned cores() const;
};
CoreAllowance core_allowance(const SystemFiles& files = {});

/// The cores that this process may use, as it found them when it first asked: whoever takes as many threads as there
/// are cores asks here.
unsigned usable_cores();

/// The least that the control groups allow which this process is in, and those around them; none: as much as there is.
std::optional<std::uint64_t> memory_of_group(const SystemFiles& files = {});
std::optional<std::uint64_t> threads_of_group(const SystemFiles& files = {});

/// Bytes that this process may use: of the machine, or of its control group. 0: not known.
std::uint64_t usable_memory(const SystemFiles& files = {});

}  // namespace lightnet
