#include "core/run/place/own_time.hpp"

#include <time.h>

namespace lightnet {

OwnTime::Nanoseconds OwnTime::now() const {
    timespec time{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return std::chrono::seconds(time.tv_sec) + Nanoseconds(time.tv_nsec) + slept_;
}

}  // namespace lightnet
