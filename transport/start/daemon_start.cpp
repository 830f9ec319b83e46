#include "transport/start/daemon_start.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

namespace lightnet {

std::optional<std::string> endpoint_said(int out, Patience& patience) {
    std::string line;
    while (line.find('\n') == std::string::npos && !patience.is_over()) {
        pollfd item{out, POLLIN, 0};
        if (poll(&item, 1, static_cast<int>(patience.until_look().count())) <= 0) continue;
        char buffer[256];
        const auto n = read(out, buffer, sizeof buffer);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) break;
        line.append(buffer, static_cast<std::size_t>(n));
    }
    const std::string before = "listening on ";
    const auto at = line.find(before), ends = line.find_first_of("\"\n", std::min(at, line.size()));
    if (at == std::string::npos || ends == std::string::npos) return std::nullopt;
    return line.substr(at + before.size(), ends - at - before.size());
}

}  // namespace lightnet
