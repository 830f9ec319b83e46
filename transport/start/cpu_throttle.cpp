#include "transport/start/cpu_throttle.hpp"

#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstring>
#include <mutex>

#include "core/base/error.hpp"

namespace lightnet {
namespace {

constexpr std::chrono::duration<double> turn{0.004};  // in which it runs: short beside what a tile takes

// Called by their numbers: the functions of glibc 2.36 can't be linked with C++.
int handle_of(int process) { return static_cast<int>(syscall(SYS_pidfd_open, process, 0)); }
bool send(int handle, int signal) { return syscall(SYS_pidfd_send_signal, handle, signal, nullptr, 0) == 0; }

}  // namespace

CpuThrottle::CpuThrottle(int process, double times) : handle_(handle_of(process)) {
    if (handle_ < 0) throw Error(std::string("a local worker can't be made slow: ") + std::strerror(errno));
    thread_ = std::jthread([this, times](const std::stop_token& stop) { hold(stop, times); });
}

CpuThrottle::~CpuThrottle() {
    thread_.request_stop();
    thread_.join();
    close(handle_);
}

void CpuThrottle::hold(const std::stop_token& stop, double times) const {
    std::mutex mutex;
    std::condition_variable_any woken;
    const auto sleep = [&](std::chrono::duration<double> time) {
        std::unique_lock lock(mutex);
        woken.wait_for(lock, stop, time, [] { return false; });
    };
    while (!stop.stop_requested()) {
        sleep(turn);
        if (!send(handle_, SIGSTOP)) return;  // it has ended
        sleep(turn * (times - 1));
        send(handle_, SIGCONT);
    }
}

}  // namespace lightnet
