// Runs in whose middle something is to happen, on machines of any speed.
#pragma once

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
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
inline Launch rendered_for(std::chrono::milliseconds length, const std::string& graph, std::vector<std::string>& words,
                           std::chrono::milliseconds patience) {
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

/// rendered_for(), kept beside the programs that made it: each test is a process of its own, and the next one of its
/// suite wants the same picture.
inline Launch launch_for(std::chrono::milliseconds length, const std::string& graph, std::vector<std::string>& words,
                         std::chrono::milliseconds patience = slowdown * std::chrono::seconds(60)) {
    const auto made_by =
        std::to_string(std::filesystem::last_write_time(program("lightnet")).time_since_epoch().count());
    std::string name = bytes_of(graph) + std::to_string(length.count());
    for (const auto& word : words) name += '\n' + word;
    const auto all = std::filesystem::path(LIGHTNET_PROGRAMS) / "kept_by_tests", ours = all / made_by,
               kept = ours / std::to_string(std::hash<std::string>()(name));
    const auto samples = std::find(words.begin(), words.end(), "--samples") + 1;
    if (std::filesystem::exists(kept)) {
        *samples = bytes_of(kept / "samples");
        return {0, {}, bytes_of(kept / "picture"), bytes_of(kept / "report")};
    }
    auto made = rendered_for(length, graph, words, patience);
    if (made.code != 0) return made;
    std::filesystem::create_directories(ours);
    std::error_code ignored;
    for (const auto& of_others : std::filesystem::directory_iterator(all))  // of programs that are there no more
        if (of_others.path() != ours) std::filesystem::remove_all(of_others.path(), ignored);
    const Folder fresh(ours);
    fresh.write("whole/samples", *samples), fresh.write("whole/picture", made.picture);
    fresh.write("whole/report", made.report);
    std::filesystem::rename(fresh / "whole", kept, ignored);  // another one may have been first
    return made;
}

}  // namespace lightnet::test
