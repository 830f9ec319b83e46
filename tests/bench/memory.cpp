// A consumer that is 100 times too slow: askers wait for it with full hands, and nothing piles up anywhere.
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <future>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "core/run/message/tuning.hpp"
#include "tests/bench/daemon.hpp"
#include "tests/bench/figure.hpp"
#include "tests/bench/judge.hpp"
#include "tests/support/folder.hpp"
#include "transport/launcher/ask_state.hpp"
#include "transport/start/child.hpp"

namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

const auto warm_up = lightnet::bench::sized(60s, 2s),
           measured = warm_up;  // until each part of memory has been used once
constexpr double mib = 1 << 20;
const double bundles_of_credit = lightnet::Tuning{}.credit;  // that an asker has under way to one place

// Resident memory, bytes; 0: the process is gone.
double resident(int process) {
    std::ifstream in("/proc/" + std::to_string(process) + "/statm");
    double all = 0, pages = 0;
    in >> all >> pages;
    return pages * static_cast<double>(sysconf(_SC_PAGE_SIZE));
}

// Bundles that have come to the host and are not answered.
double waiting_at(const std::string& endpoint) {
    const auto host = lightnet::ask_state({lightnet::AskedHost{endpoint}}, 3s).at(0);
    return static_cast<double>(host.bundles) - static_cast<double>(host.progress);
}

}  // namespace

int main() {
    const lightnet::test::Folder folder;
    const std::string cache = folder / "cache";
    const lightnet::bench::Daemon asker(LIGHTNET_STARTS_LIGHTNETD, 1, cache),
        consumer(LIGHTNET_STARTS_LIGHTNETD, 1, cache);
    std::map<std::string, int> processes{{"asker", asker.process()}, {"consumer", consumer.process()}};
    std::ofstream(folder / "hosts.lua") << "place '" << asker.endpoint()
                                        << "' { image = 1, direct = 1, lighting = 1 }\n"
                                        << "place '" << consumer.endpoint() << "' { bounce = 1 }\n";
    int out = -1;
    processes["launcher"] = lightnet::spawn(
        {LIGHTNET_STARTS_LIGHTNET, "run", LIGHTNET_SOURCE_DIR "/graphs/cornell.lua", "--hosts", folder / "hosts.lua",
         "--size", "512x512", "--samples", "4096", "-o", folder / "x.exr", "--progress", "none"},
        &out);
    // One hundredth of the time is left to the consumer; its lease lasts longer than it ever stops.
    const auto begun = Clock::now();
    std::map<std::string, std::vector<lightnet::bench::MemorySample>> sizes;
    std::vector<double> waiting;
    for (int round = 0; Clock::now() - begun < warm_up + measured; ++round) {
        std::future<double> asked;
        if (Clock::now() - begun > 1s) {
            kill(processes["consumer"], SIGSTOP);
            // Asked while it stands still, so that it says what has come together before it works any of that off.
            if (round % 10 == 0 || waiting.empty())
                asked = std::async(std::launch::async, waiting_at, consumer.endpoint());
            std::this_thread::sleep_for(495ms);
            kill(processes["consumer"], SIGCONT);
        }
        std::this_thread::sleep_for(5ms);
        if (asked.valid()) waiting.push_back(asked.get());
        const std::chrono::duration<double> seconds = Clock::now() - begun;
        if (seconds < warm_up) continue;
        for (const auto& [name, process] : processes) sizes[name].push_back({seconds.count(), resident(process)});
    }
    bool gone = false;
    for (const auto& [name, process] : processes) {
        const auto& all = sizes[name];
        const auto [least, most] =
            std::minmax_element(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.bytes < b.bytes; });
        std::printf("  %s: from %.1f to %.1f MiB\n", name.c_str(), least->bytes / mib, most->bytes / mib);
        gone |= least->bytes == 0;
        // The middle slope, and between which half of all slopes lie.
        std::vector<double> per_minute;
        for (const double part : {0.25, 0.5, 0.75}) per_minute.push_back(lightnet::bench::growth(all, part) * 60 / mib);
        lightnet::bench::quantity("memory." + name, per_minute, "MiB a minute", 1, false);
    }
    // Else nobody was slow, and that nothing piled up says nothing.
    lightnet::bench::quantity("memory.waiting", waiting, "bundles", bundles_of_credit / 2, true);
    lightnet::bench::quantity("memory.piled_up", {*std::max_element(waiting.begin(), waiting.end())}, "bundles",
                              bundles_of_credit, false);
    kill(processes["launcher"], SIGKILL);
    waitpid(processes["launcher"], nullptr, 0);
    if (gone) std::fprintf(stderr, "memory: not all processes lived to the end\n");
    return gone ? 1 : 0;
}
