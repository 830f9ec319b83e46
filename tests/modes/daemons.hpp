// Daemons and launches for tests.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "tests/support/process.hpp"
#include "tests/support/slowdown.hpp"

namespace lightnet::test {

inline std::string program(const std::string& name) { return std::string(LIGHTNET_PROGRAMS) + "/" + name; }
inline std::string graph_file(const std::string& name) { return std::string(LIGHTNET_SOURCE_DIR) + "/graphs/" + name; }

/// Is it still there, unless the test has waited for its end or sent it a signal?
inline void expect_alive(Process& daemon) {
    if (daemon.was_expected_to_end() || daemon.lives()) return;
    EXPECT_EQ(daemon.code(), 0) << "a daemon is gone that nobody has ended\n" << daemon.output();
}

/// A lightnetd on a port of its own (or on `listen`).
class Daemon {
public:
    explicit Daemon(const Folder& folder, int places = 1, const std::string& listen = "tcp://127.0.0.1:*",
                    std::vector<std::string> more = {}) {
        std::vector<std::string> words{program("lightnetd"),   "--listen", listen,          "--places",
                                       std::to_string(places), "--cache",  folder / "cache"};
        words.insert(words.end(), more.begin(), more.end());
        process = std::make_unique<Process>(words);
        const std::string before = "listening on ";
        EXPECT_TRUE(process->wait_for("\n")) << process->output();
        const auto at = process->output().find(before);
        if (at == std::string::npos) return;
        endpoint = process->output().substr(at + before.size(),
                                            process->output().find_first_of("\"\n", at) - at - before.size());
    }
    // Whatever a run does costs the run alone.
    ~Daemon() {
        if (process) expect_alive(*process);
    }
    Daemon(Daemon&&) = default;
    std::unique_ptr<Process> process;
    std::string endpoint;
};

/// A lightnetd that dials out to a launcher, and lets nobody in.
inline std::unique_ptr<Process> joining_daemon(const Folder& folder, const std::string& launcher,
                                               const std::string& name, std::vector<std::string> more = {}) {
    std::vector<std::string> words{program("lightnetd"), "--join", launcher,  "--name",        name,
                                   "--places",           "1",      "--cache", folder / "cache"};
    words.insert(words.end(), more.begin(), more.end());
    return std::make_unique<Process>(words);
}

/// Where the hosts of a run may join, as it says itself.
inline std::string join_endpoint(Process& run) {
    const std::string before = "hosts may join at ";
    EXPECT_TRUE(run.wait_for(before) && run.wait_for("\n")) << run.output();
    const auto at = run.output().find(before) + before.size();
    return run.output().substr(at, run.output().find_first_of("\"\n", at) - at);
}

/// Renders a graph with these words behind it; the bytes of the EXR file.
struct Launch {
    int code = -1;
    std::string said, picture, report;
};

inline std::vector<std::string> launch_words(const std::string& graph, const std::filesystem::path& out,
                                             const std::vector<std::string>& more) {
    std::vector<std::string> words{program("lightnet"), "run", graph, "-o", out.string()};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

inline Launch finish(Process& process, const std::filesystem::path& out,
                     std::chrono::milliseconds patience = slowdown * std::chrono::seconds(60)) {
    Launch launch;
    launch.code = process.wait(patience);
    launch.said = process.output();
    if (launch.code != 0) return launch;
    launch.picture = bytes_of(out);
    launch.report = bytes_of(std::filesystem::path(out).replace_extension(".run.json"));
    return launch;
}

inline Launch launch(const std::string& graph, const Folder& folder, const std::vector<std::string>& more,
                     std::chrono::milliseconds patience = slowdown * std::chrono::seconds(60)) {
    const auto out = folder / "picture.exr";
    Process process(launch_words(graph, out, more));
    return finish(process, out, patience);
}

/// What a report counted for all of its run; edges and nodes have numbers of these names, too.
inline double counter(const std::string& report, const std::string& name) {
    const auto at = report.find("\"" + name + "\": ", report.find("\"counters\": "));
    EXPECT_NE(at, std::string::npos) << name;
    return at == std::string::npos ? -1 : std::stod(report.substr(at + name.size() + 4));
}

}  // namespace lightnet::test
