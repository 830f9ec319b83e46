// Runs in whose middle something is to happen, on machines of any speed.
#pragma once

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include "tests/modes/daemons.hpp"

namespace lightnet::test {

/// What the processes that this one has started and waited for have computed so far.
inline std::chrono::microseconds computed_by_children() {
    rusage used{};
    ::getrusage(RUSAGE_CHILDREN, &used);
    const auto length = [](const timeval& time) {
        return std::chrono::seconds(time.tv_sec) + std::chrono::microseconds(time.tv_usec);
    };
    return length(used.ru_utime) + length(used.ru_stime);
}

/// What two threads make of a graph by `words`, who compute for `length` at least: where they are done sooner, the
/// number behind --samples is raised, for the runs that are to be compared with this one as well. Told from processor
/// time, as others may hold this run up and not the next.
inline Launch launch_for(std::chrono::milliseconds length, const std::string& graph, std::vector<std::string>& words,
                         std::chrono::milliseconds patience = slowdown * std::chrono::seconds(60)) {
    const auto render = [&] {
        const Folder folder;
        auto threaded = words;
        threaded.insert(threaded.end(), {"--threads", "2"});
        return launch(graph, folder, threaded, patience);
    };
    const auto before = computed_by_children();
    auto first = render();
    const auto took =
        std::max<std::chrono::microseconds>((computed_by_children() - before) / 2, std::chrono::milliseconds(100));
    EXPECT_EQ(first.code, 0) << first.said;
    if (took >= length) return first;
    auto& samples = *(std::find(words.begin(), words.end(), "--samples") + 1);
    samples = std::to_string(std::stoi(samples) * (length / took + 1));
    return render();
}

}  // namespace lightnet::test
