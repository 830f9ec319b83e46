// A consumer that is 100 times too slow: askers wait for it, and nothing piles up anywhere.
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "tests/bench/figure.hpp"
#include "transport/child.hpp"

namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto warm_up = 8s, measured = 24s;  // the first checkpoint is written after 5 s

std::string first_line(int in) {
    std::string line;
    for (char c = 0; read(in, &c, 1) == 1 && c != '\n';) line += c;
    return line;
}

// Resident memory, bytes; 0: the process is gone.
double resident(int process) {
    std::ifstream in("/proc/" + std::to_string(process) + "/statm");
    double all = 0, pages = 0;
    in >> all >> pages;
    return pages * static_cast<double>(sysconf(_SC_PAGE_SIZE));
}

}  // namespace

int main() {
    const auto folder = std::filesystem::temp_directory_path() / ("lightnet-memory-" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    const std::string before = "listening on ";
    std::map<std::string, int> processes;
    std::vector<std::string> endpoints;
    for (const char* name : {"asker", "consumer"}) {
        int out = -1;
        processes[name] =
            lightnet::spawn({LIGHTNET_DAEMON, "--places", "1", "--quiet", "--cache", folder / "cache"}, &out);
        endpoints.push_back(first_line(out).substr(before.size()));
    }
    std::ofstream(folder / "hosts.lua") << "place '" << endpoints[0] << "' { image = 1, direct = 1, lighting = 1 }\n"
                                        << "place '" << endpoints[1] << "' { bounce = 1 }\n";
    int out = -1;
    processes["launcher"] = lightnet::spawn(
        {LIGHTNET_LAUNCHER, "run", LIGHTNET_SOURCE_DIR "/graphs/cornell.lua", "--hosts", folder / "hosts.lua", "--size",
         "512x512", "--samples", "4096", "-o", folder / "x.exr", "--progress", "none"},
        &out);
    // One hundredth of the time is left to the consumer; its lease lasts longer than it ever stops.
    const auto begun = Clock::now();
    std::map<std::string, std::vector<double>> sizes;
    while (Clock::now() - begun < warm_up + measured) {
        if (Clock::now() - begun > 1s) {
            kill(processes["consumer"], SIGSTOP);
            std::this_thread::sleep_for(495ms);
            kill(processes["consumer"], SIGCONT);
        }
        std::this_thread::sleep_for(5ms);
        if (Clock::now() - begun < warm_up) continue;
        for (const auto& [name, process] : processes) sizes[name].push_back(resident(process));
    }
    for (const auto& [name, process] : processes) {
        // A checkpoint on its way to the disk takes room for a moment: what counts is whether that is given back.
        const auto& all = sizes[name];
        const auto third = static_cast<std::ptrdiff_t>(all.size() / 3);
        const double early = lightnet::bench::median({all.begin(), all.begin() + third});
        const double late = lightnet::bench::median({all.end() - third, all.end()});
        const auto [least, most] = std::minmax_element(all.begin(), all.end());
        std::printf("  %s: %.1f MiB early, %.1f MiB late, from %.1f to %.1f\n", name.c_str(), early / (1 << 20),
                    late / (1 << 20), *least / (1 << 20), *most / (1 << 20));
        lightnet::bench::figure(("memory." + name).c_str(), early > 0 && late > 0 ? late / early - 1 : 1, 0.05, false);
    }
    for (const auto& [name, process] : processes) kill(process, SIGKILL);
    for (const auto& [name, process] : processes) waitpid(process, nullptr, 0);
    std::filesystem::remove_all(folder);
}
