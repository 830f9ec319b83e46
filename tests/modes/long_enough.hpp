// Runs in whose middle something is to happen, on machines of any speed.
#pragma once

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include "tests/modes/daemons.hpp"

namespace lightnet::test {

/// What two threads make of a graph by `words`, in `length` at least: where they are done sooner, the number behind
/// --samples is raised, for the runs that are to be compared with this one as well.
inline Launch launch_for(std::chrono::milliseconds length, const std::string& graph, std::vector<std::string>& words,
                         std::chrono::milliseconds patience = slowdown * std::chrono::seconds(60)) {
    using Clock = std::chrono::steady_clock;
    const auto render = [&] {
        const Folder folder;
        auto threaded = words;
        threaded.insert(threaded.end(), {"--threads", "2"});
        return launch(graph, folder, threaded, patience);
    };
    const auto begun = Clock::now();
    auto first = render();
    const auto took = std::max<Clock::duration>(Clock::now() - begun, std::chrono::milliseconds(100));
    EXPECT_EQ(first.code, 0) << first.said;
    if (took >= length) return first;
    auto& samples = *(std::find(words.begin(), words.end(), "--samples") + 1);
    samples = std::to_string(std::stoi(samples) * (length / took + 1));
    return render();
}

}  // namespace lightnet::test
