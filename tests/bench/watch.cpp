// What it costs to be watched: processor time of the same run, not watched at all, with a server that nobody calls, and
// with a page open that takes all that comes. In turns. And what a launcher would spend on what a thousand hosts say,
// as they say it: figures with every other heartbeat, and a state for the page.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/run/message/figures.hpp"
#include "tests/bench/figure.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/parse.hpp"
#include "tests/watch/visitor.hpp"
#include "tools/watch/watch_json.hpp"
#include "transport/start/child.hpp"

namespace {

using namespace std::chrono_literals;

const int rounds = lightnet::bench::repeated(9);

// What it says until it ends; a page is opened where it says that one can be.
std::string attended(int out, bool open) {
    std::string said;
    std::array<char, 4096> part{};
    const std::string mark = "watch it at http://127.0.0.1:";
    while (const auto size = ::read(out, part.data(), part.size())) {
        if (size < 0) break;
        said.append(part.data(), static_cast<std::size_t>(size));
        const auto at = said.find(mark);
        if (!open || at == std::string::npos || said.find('\n', at) == std::string::npos) continue;
        open = false;
        const auto port = static_cast<std::uint16_t>(std::atoi(said.c_str() + at + mark.size()));
        lightnet::test::Visitor page(port);
        if (!page.watch("127.0.0.1:" + std::to_string(port))) throw std::runtime_error("the page does not open");
        while (page.next(30s)) {
        }
    }
    return said;
}

// Processor seconds of a run.
double cost_of(const lightnet::test::Folder& folder, bool watched, bool open) {
    std::vector<std::string> words{"sh",
                                   "-c",
                                   "exec \"$0\" \"$@\" 2>&1",  // where to watch it is said there
                                   LIGHTNET_STARTS_LIGHTNET,
                                   "run",
                                   LIGHTNET_SOURCE_DIR "/graphs/cornell.lua",
                                   "--threads",
                                   "2",
                                   "--size",
                                   lightnet::bench::sized("192x192", "32x32"),
                                   "--samples",
                                   lightnet::bench::sized("128", "4"),
                                   "--forget",
                                   "-o",
                                   folder.file("x.exr")};
    if (watched) words.emplace_back("--watch");
    int out = -1;
    const int process = lightnet::spawn(words, &out);
    const auto said = attended(out, open);
    ::close(out);
    int status = 0;
    rusage used{};
    if (wait4(process, &status, 0, &used) != process || !WIFEXITED(status) || WEXITSTATUS(status) != 0)
        throw std::runtime_error("the run failed: " + said);
    const auto seconds = [](const timeval& time) { return double(time.tv_sec) + 1e-6 * double(time.tv_usec); };
    return seconds(used.ru_utime) + seconds(used.ru_stime);
}

struct ThousandHosts {
    std::vector<double> shares;  // of a core
    double bytes = 0;            // of a state
};

// Sixteen places each, a network of ten nodes.
ThousandHosts thousand_hosts() {
    constexpr std::size_t count = 1000, nodes = 10;
    constexpr double figures_period = 0.8, state_period = 0.4;  // seconds; RemoteHost, Watcher
    std::string text = "inner0 = Ambient {}\n";
    for (std::size_t i = 1; i < nodes; ++i)
        text += "inner" + std::to_string(i) + " = Cache { inner" + std::to_string(i - 1) + " }\n";
    const auto graph = lightnet::test::sound_graph(text + "lighting = Cache { inner9 }");
    lightnet::HostFigures figures;
    figures.places.resize(16, {1'000'000, 200'000, 30'000, 4'000});
    figures.nodes.resize(graph.nodes.size(), {100'000, 7, 90'000, 9'000'000, 900'000'000, 80'000'000'000, 90'000});
    figures.edges.resize(nodes, {9'000'000, 90'000, 8'000'000, 900'000'000});
    const auto said = to_text(figures);
    lightnet::WatchedState state;
    for (std::size_t i = 0; i < count; ++i)
        state.hosts.push_back({"tcp://10.0." + std::to_string(i / 250) + "." + std::to_string(i % 250) + ":7777",
                               "is ready",
                               i != 777,
                               16,
                               90'000,
                               {},
                               figures});
    ThousandHosts measured;
    for (int round = 0; round < rounds; ++round) {
        const double begun = lightnet::bench::thread_seconds();
        for (auto& host : state.hosts) host.figures = lightnet::figures_from(said).value();
        const double heard = lightnet::bench::thread_seconds();
        measured.bytes = static_cast<double>(state_json(state, graph).size());
        const double told = lightnet::bench::thread_seconds();
        measured.shares.push_back((heard - begun) / figures_period + (told - heard) / state_period);
    }
    return measured;
}

}  // namespace

int main() {
    return lightnet::bench::run("watch", [] {
        const auto hosts = thousand_hosts();
        lightnet::bench::figure("watch.thousand_hosts", hosts.shares, 0.02, false);
        lightnet::bench::quantity("watch.thousand_hosts_state", {hosts.bytes / 1000}, "kB", 20, false);
        const lightnet::test::Folder folder;
        cost_of(folder, false, false);  // warms up
        std::vector<double> plain, open, closed;
        for (int round = 0; round < rounds; ++round) {
            const double before = cost_of(folder, false, false);
            const double with_page = cost_of(folder, true, true), alone = cost_of(folder, true, false);
            const double usual = (before + cost_of(folder, false, false)) / 2;
            plain.push_back(usual);
            open.push_back(with_page / usual - 1);
            closed.push_back(alone / usual - 1);
        }
        lightnet::bench::show("processor seconds, not watched", plain);
        lightnet::bench::figure("watch.open", open, 0.005, false);
        lightnet::bench::figure("watch.closed", closed, 0.005, false);
    });
}
