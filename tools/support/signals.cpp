#include "tools/support/signals.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <initializer_list>

namespace lightnet {
namespace {

// A handler can reach nothing else.
Signals caught;
std::atomic<bool> only_warned{false};  // by Slurm, which sends another signal later

void note_time() { caught.came = std::chrono::steady_clock::now().time_since_epoch().count(); }

void on_signal(int signal, siginfo_t* of, void*) {
    const bool warns = signal == SIGUSR1;
    if (warns && of && of->si_code == SI_QUEUE) caught.said = of->si_value.sival_int;
    const bool again = caught.any.exchange(true) && !(!warns && only_warned.exchange(false));
    if (warns && !again) only_warned = true;
    if (again && !warns && signal != SIGHUP) _exit(130);
    if (!again) note_time();
    (signal == SIGINT ? caught.interrupted : caught.terminated) = true;
}

int code_at_first = 0;
std::string_view words_at_first;

void end_at_once(int, siginfo_t*, void*) {
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, words_at_first.data(), words_at_first.size());
    _exit(code_at_first);
}

bool is_ignored(int signal) {
    struct sigaction action {};
    return sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

void take(std::initializer_list<int> which, void (*handler)(int, siginfo_t*, void*)) {
    struct sigaction action {};
    action.sa_sigaction = handler;
    action.sa_flags = SA_SIGINFO;
    for (const int signal : which)
        if (!is_ignored(signal)) sigaction(signal, &action, nullptr);
}

}  // namespace

void ask_to_stop() {
    caught.terminated = true;
    if (!caught.any.exchange(true)) note_time();
}

std::chrono::duration<double> time_to_end(const Signals& told) {
    constexpr std::chrono::seconds patience(9);  // of Docker: ten
    const std::chrono::steady_clock::duration came(told.came.load());
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return std::max<std::chrono::duration<double>>(came + patience - now, std::chrono::seconds(0));
}

void end_on_signals(int code, std::string_view words) {
    code_at_first = code, words_at_first = words;
    take({SIGINT, SIGTERM, SIGHUP}, end_at_once);
    take({SIGUSR1}, [](int, siginfo_t*, void*) {});
}

const Signals& watch_signals() {
    take({SIGINT, SIGTERM, SIGHUP, SIGUSR1}, on_signal);
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);  // a file that grows too large is an error like a full disk
    return caught;
}

}  // namespace lightnet
