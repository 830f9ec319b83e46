// Processor time of threads.
#pragma once

#include <chrono>
#include <ctime>

namespace lightnet {

/// Processor time of the calling thread: what other programs take from a machine is not in it. A call of the system.
inline std::chrono::nanoseconds thread_processor_time() {
    timespec time{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

}  // namespace lightnet
