// Loaded before a program, this makes its calendar wrong: by LIGHTNET_WRONG_DAYS days, or, if that says "jumps", by up
// to ten days either way, another at each look. The steady clock is as it was.
#include <sys/time.h>
#include <time.h>

#include <cstdlib>
#include <cstring>

#include <dlfcn.h>

namespace {

constexpr long day = 86400;

long wrong_by() {
    const char* const days = std::getenv("LIGHTNET_WRONG_DAYS");
    if (!days) return 0;
    if (std::strcmp(days, "jumps") != 0) return std::atol(days) * day;
    static thread_local unsigned state = 1;
    state = state * 1664525u + 1013904223u;
    return (static_cast<long>(state >> 8) % 20 - 10) * day;
}

}  // namespace

extern "C" int clock_gettime(clockid_t clock, timespec* now) {
    using Original = int (*)(clockid_t, timespec*);
    static const auto original = reinterpret_cast<Original>(dlsym(RTLD_NEXT, "clock_gettime"));
    const int result = original(clock, now);
    if (result == 0 && (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE)) now->tv_sec += wrong_by();
    return result;
}

extern "C" int gettimeofday(timeval* now, void*) {
    timespec precise{};
    const int result = clock_gettime(CLOCK_REALTIME, &precise);
    *now = {precise.tv_sec, precise.tv_nsec / 1000};
    return result;
}

extern "C" time_t time(time_t* kept) {
    timespec now{};
    clock_gettime(CLOCK_REALTIME, &now);
    if (kept) *kept = now.tv_sec;
    return now.tv_sec;
}
