#include "tools/signals.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>

namespace lightnet {
namespace {

// A handler can reach nothing else.
Signals signals;
std::atomic<bool> only_warned{false};  // by Slurm, which sends another signal later

void note_time() { signals.came = std::chrono::steady_clock::now().time_since_epoch().count(); }

void on_signal(int signal) {
    const bool warns = signal == SIGUSR1;
    const bool again = signals.any.exchange(true) && !(!warns && only_warned.exchange(false));
    if (warns && !again) only_warned = true;
    if (again && !warns && signal != SIGHUP) _exit(130);
    if (!again) note_time();
    (signal == SIGINT ? signals.interrupted : signals.terminated) = true;
}

bool is_ignored(int signal) {
    struct sigaction action {};
    return sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

}  // namespace

void ask_to_stop() {
    signals.terminated = true;
    if (!signals.any.exchange(true)) note_time();
}

std::chrono::duration<double> time_to_end(const Signals& told) {
    constexpr std::chrono::seconds patience(9);  // of Docker: ten
    const std::chrono::steady_clock::duration came(told.came.load());
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return std::max<std::chrono::duration<double>>(came + patience - now, std::chrono::seconds(0));
}

const Signals& watch_signals() {
    struct sigaction action {};
    action.sa_handler = on_signal;
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGUSR1})
        if (!is_ignored(signal)) sigaction(signal, &action, nullptr);
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);  // a file that grows too large is an error like a full disk
    return signals;
}

}  // namespace lightnet
