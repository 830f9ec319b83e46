#include "tools/signals.hpp"

#include <unistd.h>

#include <csignal>

namespace lightnet {
namespace {

Signals signals;   // a handler can reach nothing else

void on_signal(int signal) {
    if (signals.any.exchange(true)) _exit(130);
    (signal == SIGINT ? signals.interrupted : signals.terminated) = true;
}

}  // namespace

const Signals& watch_signals() {
    struct sigaction action {};
    action.sa_handler = on_signal;
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    std::signal(SIGPIPE, SIG_IGN);
    return signals;
}

}  // namespace lightnet
