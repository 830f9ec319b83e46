#include "tools/daemon/led_by_input.hpp"

#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string>

#include "core/base/error.hpp"
#include "core/base/spare_threads.hpp"
#include "tools/support/signals.hpp"

namespace lightnet {
namespace {

// What comes is thrown away.
void wait_for_end_of_input(const std::stop_token& stop) {
    constexpr int look_ms = 100;
    std::array<char, 256> skipped;
    while (!stop.stop_requested()) {
        pollfd input{STDIN_FILENO, POLLIN, 0};
        if (::poll(&input, 1, look_ms) <= 0) continue;
        const auto size = ::read(STDIN_FILENO, skipped.data(), skipped.size());
        if (size == 0 || (size < 0 && errno != EINTR && errno != EAGAIN)) return ask_to_stop();
    }
}

}  // namespace

std::optional<KeyPair> key_from_input() {
    constexpr std::size_t most = 256;
    std::string line;
    for (char c = 0; line.size() < most;) {
        const auto size = ::read(STDIN_FILENO, &c, 1);
        if (size < 0 && errno == EINTR) continue;
        if (size <= 0) return std::nullopt;
        if (c == '\n') break;
        line += c;
    }
    const auto key = KeyPair::from_secret(line);
    if (!key) throw Error("the standard input", "does not begin with a secret key");
    return key;
}

LedByInput::LedByInput() {
    want_threads(1, "--led");
    thread_ = std::jthread(wait_for_end_of_input);
}

}  // namespace lightnet
