// Makes a process of this machine slow, whatever it does.
#pragma once

#include <stop_token>
#include <thread>

namespace lightnet {

/// Stops a child process and lets it go on, many times a second, so that all that it does takes so many times as long.
/// Has a thread of its own. When the process ends, that is all; at the end of this object it goes on at full speed.
class CpuThrottle {
public:
    /// `times`: at least 1. Throws Error when there is no such process.
    CpuThrottle(int process, double times);
    ~CpuThrottle();
    CpuThrottle(const CpuThrottle&) = delete;
    CpuThrottle& operator=(const CpuThrottle&) = delete;

private:
    void hold(const std::stop_token& stop, double times) const;

    int handle_;  // names this process, even when its number is another's later
    std::jthread thread_;
};

}  // namespace lightnet
