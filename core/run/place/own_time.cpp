#include "core/run/place/own_time.hpp"

#include "core/base/own_process.hpp"
#include "core/base/processor_time.hpp"

namespace lightnet {
OwnTime::OwnTime() : ready_before_(thread_ready_time()) {}

double OwnTime::share_of(Nanoseconds at_work) const {
    constexpr double least = 0.01;  // clocks of two kinds don't agree to the last
    if (at_work.count() <= 0) return 1;
    const auto ready = thread_ready_time() - ready_before_ - overslept_;
    return std::clamp(1 - static_cast<double>(ready.count()) / static_cast<double>(at_work.count()), least, 1.0);
}

OwnTime::Nanoseconds OwnTime::now() const { return thread_processor_time() + slept_; }

}  // namespace lightnet
