// Figures of a host, as other threads may read them.
#pragma once

#include <chrono>
#include <mutex>
#include <utility>

#include "transport/daemon/host.hpp"

namespace lightnet {

/// Set by the thread of serve() a few times a second; read by any thread.
class ShownFigures {
public:
    using Time = std::chrono::steady_clock::time_point;
    bool are_old(Time now) const { return now - told_ >= std::chrono::milliseconds(250); }
    void show(DaemonFigures next, Time now) {
        told_ = now;
        const std::lock_guard lock(mutex_);
        shown_ = std::move(next);
    }
    DaemonFigures read() const {
        const std::lock_guard lock(mutex_);
        return shown_;
    }

private:
    Time told_{};
    mutable std::mutex mutex_;
    DaemonFigures shown_;
};

}  // namespace lightnet
