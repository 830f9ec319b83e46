#include "core/base/this_machine.hpp"

#include <unistd.h>

#include <array>
#include <chrono>

namespace lightnet {

std::string machine_name() {
    std::array<char, 256> name{};
    return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

std::uint64_t machine_memory() {
    const long pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGE_SIZE);
    return pages > 0 && size > 0 ? static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(size) : 0;
}

std::string process_name() { return machine_name() + " " + std::to_string(getpid()); }

std::uint64_t steady_nanoseconds() {
    const std::chrono::nanoseconds now = std::chrono::steady_clock::now().time_since_epoch();
    return static_cast<std::uint64_t>(now.count());
}

}  // namespace lightnet
