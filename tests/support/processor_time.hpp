// What this thread has computed, for tests of how much work something is.
#pragma once

#include <ctime>

#include <chrono>

namespace lightnet::test {

/// Processor time of the calling thread: what other processes take from a machine is not in it.
inline std::chrono::nanoseconds processor_time() {
    timespec time{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

}  // namespace lightnet::test
