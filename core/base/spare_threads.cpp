#include "core/base/spare_threads.hpp"

#include <chrono>
#include <latch>
#include <system_error>
#include <thread>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/own_process.hpp"

namespace lightnet {
namespace {

constexpr std::size_t taken_meanwhile = 1;  // by the allocator, say

// A thread that was joined may count for a moment longer, until the system has buried it.
void wait_for_burial(std::size_t threads_before) {
    constexpr auto patience = std::chrono::milliseconds(200);  // others of this process may have started some
    const auto end = std::chrono::steady_clock::now() + patience;
    while (own_threads() > threads_before && std::chrono::steady_clock::now() < end)
        std::this_thread::sleep_for(std::chrono::microseconds(50));
}

}  // namespace

std::size_t try_threads(std::size_t count) {
    const auto before = own_threads();
    std::size_t made = 0;
    {
        std::latch all_there(1);
        std::vector<std::jthread> threads;
        threads.reserve(count);
        try {
            for (; made < count; ++made) threads.emplace_back([&all_there] { all_there.wait(); });
        } catch (const std::system_error&) {
        }
        all_there.count_down();
    }
    wait_for_burial(before);
    return made;
}

void want_threads(std::size_t count, const std::string& purpose) {
    count += taken_meanwhile;
    const auto made = try_threads(count);
    if (made >= count) return;
    throw Error(purpose, "needs " + std::to_string(count) + (count == 1 ? " thread" : " threads") +
                             " more, and the system gives " + (made ? "only " + std::to_string(made) : "none") + "; " +
                             more_threads_help);
}

}  // namespace lightnet
