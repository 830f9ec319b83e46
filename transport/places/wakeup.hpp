// Wakes a thread that waits at sockets.
#pragma once

#include <chrono>

namespace lightnet {

/// Any thread may call notify(); the one that polls handle() reads that there is something, and calls clear() first.
class Wakeup {
public:
    /// Throws Error when the system has no more handles.
    Wakeup();
    ~Wakeup();
    Wakeup(const Wakeup&) = delete;
    Wakeup& operator=(const Wakeup&) = delete;

    void notify() const noexcept;
    void clear() const noexcept;
    /// Returns when there is something, or after `most`, or when the process was sent a signal.
    void wait(std::chrono::milliseconds most) const noexcept;
    /// Readable since the first notify() after the last clear().
    int handle() const { return handle_; }

private:
    int handle_;
};

}  // namespace lightnet
