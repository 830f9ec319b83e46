// Tests of the time that a place has had for itself.
#include "core/run/place/own_time.hpp"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>

#include <atomic>
#include <fstream>
#include <thread>

namespace lightnet::own_time_test {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

void stay_on(int processor) {
    cpu_set_t only;
    CPU_ZERO(&only);
    CPU_SET(processor, &only);
    ::pthread_setaffinity_np(::pthread_self(), sizeof only, &only);
}

// One that may be used.
int some_processor() {
    cpu_set_t all;
    ::sched_getaffinity(0, sizeof all, &all);
    for (int i = 0; i < CPU_SETSIZE; ++i)
        if (CPU_ISSET(i, &all)) return i;
    return 0;
}

bool system_tells() {
    std::ifstream in("/proc/thread-self/schedstat");
    return in.good();
}

TEST(OwnTime, LeavesOutWhatOthersHadOfTheProcessor) {
    const int processor = some_processor();
    std::atomic<bool> stop = false;
    std::thread other([&] {
        stay_on(processor);
        while (!stop) {
        }
    });
    double share = 0;
    std::thread place([&] {
        stay_on(processor);
        const OwnTime own;
        const auto begun = Clock::now();
        while (Clock::now() - begun < 400ms) {
        }
        share = own.share_of(Clock::now() - begun);
    });
    place.join();
    stop = true;
    other.join();
    EXPECT_GT(share, 0);
    if (system_tells())
        EXPECT_LT(share, 0.8) << "about half of it";
    else
        EXPECT_EQ(share, 1);
}

TEST(OwnTime, IsAllWhereNothingWasWaitedFor) {
    const OwnTime own;
    EXPECT_EQ(own.share_of(0ns), 1);
    EXPECT_GT(own.share_of(1h), 0.9);
}

}  // namespace
}  // namespace lightnet::own_time_test
