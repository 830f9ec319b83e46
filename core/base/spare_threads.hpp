// A trial of whether the system has threads left. Some libraries end the process when they get none, so it's tried
// beforehand.
#pragma once

#include <cstddef>
#include <future>
#include <string>
#include <system_error>
#include <type_traits>

namespace lightnet {

/// Starts so many threads at once, and ends them. How many could be had; they are free again when this returns.
std::size_t try_threads(std::size_t count);

/// Throws Error when there are fewer than `count`, with what `purpose` needs and what would help.
void want_threads(std::size_t count, const std::string& purpose);

/// Does `work` in a thread of its own; at once, where the system has none left.
template <class Work>
std::future<std::invoke_result_t<const Work&>> in_background(const Work& work) try {
    return std::async(std::launch::async, work);
} catch (const std::system_error&) {
    std::packaged_task<std::invoke_result_t<const Work&>()> task(work);
    auto made = task.get_future();
    task();
    return made;
}

/// What would help where there are too few threads.
inline constexpr const char* more_threads_help = "a higher limit (ulimit -u, TasksMax of a unit, pids.max) would help";

}  // namespace lightnet
