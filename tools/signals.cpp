#include "tools/signals.hpp"

#include <unistd.h>

#include <csignal>

namespace lightnet {
namespace {

Signals signals;  // a handler can reach nothing else

void on_signal(int signal) {
    const bool again = signals.any.exchange(true);
    if (again && signal != SIGHUP) _exit(130);
    (signal == SIGINT ? signals.interrupted : signals.terminated) = true;
}

bool is_ignored(int signal) {
    struct sigaction action {};
    return sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

}  // namespace

void ask_to_stop() {
    signals.terminated = true;
    signals.any = true;
}

const Signals& watch_signals() {
    struct sigaction action {};
    action.sa_handler = on_signal;
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    if (!is_ignored(SIGHUP)) sigaction(SIGHUP, &action, nullptr);
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);  // a file that grows too large is an error like a full disk
    return signals;
}

}  // namespace lightnet
