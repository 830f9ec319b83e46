#include "transport/zmq/process_id.hpp"

#include <pthread.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>

namespace {

std::atomic<bool> is_kept{false};
std::atomic<pid_t> kept{0};  // 0: the system is asked

pid_t ask_the_system() noexcept { return static_cast<pid_t>(syscall(SYS_getpid)); }

void look_anew() noexcept { kept.store(ask_the_system(), std::memory_order_relaxed); }

}  // namespace

// Stands in for the C library's, for this program and the libraries that it uses.
// DECISIONS: process-id-is-kept
extern "C" pid_t getpid() noexcept {
    const auto id = kept.load(std::memory_order_relaxed);
    return id != 0 ? id : ask_the_system();
}

namespace lightnet {

void keep_process_id() {
    if (is_kept.exchange(true)) return;
    if (pthread_atfork(nullptr, nullptr, look_anew) == 0) look_anew();
}

}  // namespace lightnet
