#include "transport/places/descriptors.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <system_error>

#include "core/base/error.hpp"

namespace lightnet {
namespace {

std::size_t allowed() {
    rlimit limit{};
    if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
        return std::numeric_limits<std::size_t>::max();
    return limit.rlim_cur;
}

// None when not even that can be looked up, for want of descriptors.
std::size_t open_now() {
    std::error_code none;
    std::size_t count = 0;
    auto entry = std::filesystem::directory_iterator("/proc/self/fd", none);
    if (none) return none == std::errc::too_many_files_open ? allowed() : 0;
    for (; entry != std::filesystem::directory_iterator() && !none; entry.increment(none)) ++count;
    return count;
}

}  // namespace

void raise_descriptor_limit() {
    rlimit limit{};
    if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur == limit.rlim_max) return;
    limit.rlim_cur = limit.rlim_max;
    setrlimit(RLIMIT_NOFILE, &limit);
}

std::size_t descriptors_left() {
    const auto most = allowed(), open = open_now();
    return most > open ? most - open : 0;
}

void want_descriptors(std::size_t count, const std::string& purpose) {
    const auto left = descriptors_left();
    if (left >= count) return;
    throw Error(purpose, "needs " + std::to_string(count) + " file descriptors, and this process may open only " +
                             std::to_string(left) + " more; a higher limit (ulimit -n) would help");
}

}  // namespace lightnet
