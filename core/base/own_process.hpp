// Figures of this process, for reports and metrics. Nothing that is computed depends on them.
#pragma once

#include <chrono>
#include <cstdint>

namespace lightnet {

/// A value; 0 where the system doesn't say.
struct ProcessFigures {
    std::uint64_t resident = 0, virtually = 0;  // bytes, now
    double processor_seconds = 0;               // of all its threads
    double started = 0;                         // seconds since 1970
    std::uint64_t threads = 0;
    std::uint64_t descriptors = 0, most_descriptors = 0;  // open, and that it may have
};
ProcessFigures process_figures();
/// That all its threads have had so far; 0 where the system doesn't say.
double processor_seconds();
/// So long this thread could have run while others had the processor; 0 where the system doesn't say.
std::chrono::nanoseconds thread_ready_time();
/// How many threads this process has; 0 where the system doesn't say.
std::uint64_t own_threads();

/// The most bytes of memory that it had at once since it began, or since forget_peak_memory().
std::uint64_t peak_memory();
/// From now on the peak is counted anew; false: the system doesn't do that.
bool forget_peak_memory();

}  // namespace lightnet
