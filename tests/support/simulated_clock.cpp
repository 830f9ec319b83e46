#include "tests/support/simulated_clock.hpp"

#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include "core/base/math/random.hpp"
#include "core/run/fiber/fiber.hpp"

namespace {

struct Simulated {
    bool on = false;
    std::uint64_t seed = 1, looks = 0;
    std::int64_t nanoseconds = 0;
    double slowness = 1;
} simulated;

constexpr std::int64_t second = 1'000'000'000;

// Mostly some dozens of microseconds, now and then a thousand times as long.
std::int64_t cost_of_work() {
    const auto number = lightnet::child(simulated.seed, ++simulated.looks);
    const auto part = static_cast<double>(number >> 40) * 0x1p-24;
    const double microseconds = number % 997 == 0 ? 50'000 : number % 31 == 0 ? 500 : 20;
    return static_cast<std::int64_t>(1000 * microseconds * part * simulated.slowness) + 1;
}

}  // namespace

// In place of the C library's.
extern "C" int clock_gettime(clockid_t clock, timespec* now) {
    if (!simulated.on || (clock != CLOCK_MONOTONIC && clock != CLOCK_THREAD_CPUTIME_ID))
        return static_cast<int>(::syscall(SYS_clock_gettime, clock, now));
    simulated.nanoseconds += 20;
    now->tv_sec = simulated.nanoseconds / second;
    now->tv_nsec = simulated.nanoseconds % second;
    return 0;
}

namespace lightnet {

std::uint64_t processor_ticks() {
    simulated.nanoseconds += cost_of_work();
    return static_cast<std::uint64_t>(simulated.nanoseconds);
}

namespace test {

SimulatedClock::SimulatedClock(std::uint64_t seed) { simulated = {.on = true, .seed = seed, .nanoseconds = second}; }
SimulatedClock::~SimulatedClock() { simulated.on = false; }

double SimulatedClock::seconds() const { return static_cast<double>(simulated.nanoseconds) / second; }
void SimulatedClock::set(double seconds) { simulated.nanoseconds = static_cast<std::int64_t>(seconds * second); }
void SimulatedClock::slow_down(double times) { simulated.slowness = times; }

}  // namespace test
}  // namespace lightnet
