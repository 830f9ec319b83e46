// LIGHTNET_BENCH_SAMPLES changes the samples per pixel.
#include <time.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <thread>

#include "core/base/allowance.hpp"
#include "core/base/json.hpp"
#include "nodes/standard_nodes.hpp"
#include "tests/bench/daemon.hpp"
#include "tests/bench/figure.hpp"
#include "tests/bench/paper.hpp"
#include "tests/bench/processor_group.hpp"
#include "tests/bench/stage.hpp"
#include "tests/bench/table3.hpp"
#include "tests/bench/thread_times.hpp"
#include "tests/support/folder.hpp"
#include "transport/start/child.hpp"

namespace lightnet::bench {
namespace {

using namespace std::chrono_literals;

const int rounds = repeated(3);
// Of the machine's processors; the rest is for the launcher and the system.
constexpr double part_for_hosts = 0.875;

double capacity() { return part_for_hosts * usable_cores(); }

/// A daemon that computes as quickly as so many of the seven processors.
struct SlowDaemon {
    ProcessorGroup group;  // outlives who is in it
    std::unique_ptr<Daemon> daemon;

    SlowDaemon(const std::string& name, std::uint32_t places, const test::Folder& folder)
        : group(name, capacity() * places / 7) {
        if (!group.there()) return;
        daemon = std::make_unique<Daemon>(LIGHTNET_STARTS_LIGHTNETD, places, folder / name);
        group.take(daemon->process());
        const int wrong = clock_getcpuclockid(daemon->process(), &clock);
        if (wrong != 0) throw std::system_error(wrong, std::generic_category(), "a daemon's processor time");
    }
    clockid_t clock{};
};

using SlowDaemons = std::array<const SlowDaemon*, 3>;

std::array<double, 3> seconds_computed(const SlowDaemons& daemons) {
    std::array<double, 3> seconds{};
    for (std::size_t i = 0; i < daemons.size(); ++i) seconds[i] = seconds_on(daemons[i]->clock);
    return seconds;
}

std::array<ThreadTimes, 3> times_of_threads(const SlowDaemons& daemons) {
    std::array<ThreadTimes, 3> times;
    for (std::size_t i = 0; i < daemons.size(); ++i) times[i] = thread_times(daemons[i]->daemon->process());
    return times;
}

/// Seconds that one processor computes, while another does the same: cores of a machine share its memory.
double seconds_of_work(const Registry& registry, const Graph& graph, std::uint64_t seed) {
    const auto alone = [&] {
        Stage stage(registry, graph);
        stage.use_seed(seed);
        stage.in_threads(1);
    };
    const double begun = process_seconds();
    {
        const std::jthread beside(alone);
        alone();
    }
    return (process_seconds() - begun) / 2;
}

// And says where the rest of the capacity has gone: into what daemons compute beyond the work, and into waiting.
double seconds_of_run(Stage& stage, const Registry& registry, const SlowDaemons& daemons, const Hosts& hosts,
                      std::uint64_t run) {
    std::vector<std::string> endpoints;
    for (const auto* daemon : daemons) endpoints.push_back(daemon->daemon->endpoint());
    auto options = stage.options(endpoints, run);
    const Graph graph = options.job.graph;
    options.plan = [&](const std::vector<HostOffer>& offers) { return plan(graph, registry, hosts, offers); };
    Cluster cluster(std::move(options));
    const std::atomic<bool> never{false};
    cluster.gather(20s, never);
    cluster.adopt(cluster.plan());
    const auto before = seconds_computed(daemons);
    const auto threads_before = times_of_threads(daemons);
    const Rendered made = stage.on(cluster, run);
    const auto after = seconds_computed(daemons);
    const auto threads_after = times_of_threads(daemons);
    cluster.finish();
    std::printf("  table3.real: %.2f s on three daemons, %.2f of them to prepare; they computed", made.seconds,
                made.preparing);
    for (std::size_t i = 0; i < daemons.size(); ++i)
        std::printf("%s %.2f of %.2f", i ? "," : "", after[i] - before[i],
                    made.seconds * capacity() * table3_places[i] / 7);
    std::printf(" s\n");
    for (std::size_t i = 0; i < daemons.size(); ++i)
        std::printf("    host %zu, by threads: %s s\n", i + 1, text_of(threads_after[i] - threads_before[i]).c_str());
    return made.seconds;
}

std::string text_of_file(const std::string& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

// What a user does who names nothing but hosts: preparing and rendering, without the rehearsal that tells what nodes
// cost.
double seconds_laid_out_by_itself(const SlowDaemons& daemons, const std::string& samples, std::uint64_t seed,
                                  const test::Folder& folder) {
    std::string endpoints;
    for (const auto* daemon : daemons) endpoints += (endpoints.empty() ? "" : ",") + daemon->daemon->endpoint();
    const auto layout = folder.file("auto.lua"), picture = folder.file("auto.exr");
    const auto before = seconds_computed(daemons);
    const auto output =
        run_program({LIGHTNET_STARTS_LIGHTNET, "run", LIGHTNET_SOURCE_DIR "/graphs/paper/figure5.lua", "--hosts",
                     endpoints, "--layout", "auto", "--layout-out", layout, "-D", "samples=" + samples, "--seed",
                     std::to_string(seed), "--cache", "none", "--progress", "none", "-o", picture},
                    "", 10min);
    if (output.code != 0) throw std::runtime_error(output.text);
    const auto after = seconds_computed(daemons);
    const auto report = parse_json(text_of_file(folder.file("auto.run.json")));
    double seconds = 0;
    for (const auto& phase : report.at("phases").list())
        if (phase.at("name").text() != "gather") seconds += phase.at("seconds").number();
    std::printf("  table3.auto: %.2f s; they computed", seconds);
    for (std::size_t i = 0; i < daemons.size(); ++i) std::printf("%s %.2f", i ? "," : "", after[i] - before[i]);
    std::printf(" s; laid out as\n%s", text_of_file(layout).c_str());
    return seconds;
}

}  // namespace

void measure_real_hosts() {
    const char* name = "table3.real";
    const test::Folder folder;
    const SlowDaemon one("one", table3_places[0], folder), two("two", table3_places[1], folder),
        three("three", table3_places[2], folder);
    if (!one.daemon || !two.daemon || !three.daemon)
        return not_run(name, "this system limits no process to a part of its processors (control groups)");
    const SlowDaemons daemons{&one, &two, &three};
    const Registry registry{standard_nodes()};
    const char* samples = std::getenv("LIGHTNET_BENCH_SAMPLES");
    const std::string of_pixel = samples ? samples : sized("64", "1");
    const Graph graph = paper_graph("figure5", {{"samples", of_pixel}});
    const Hosts hosts =
        paper_hosts("table3", {one.daemon->endpoint(), two.daemon->endpoint(), three.daemon->endpoint()});
    Stage stage(registry, graph);
    std::vector<double> efficiency, by_itself;
    for (std::uint64_t round = 1; round <= std::uint64_t(rounds); ++round) {
        stage.use_seed(round);  // nobody finds what was prepared before
        const double work = seconds_of_work(registry, graph, round);
        const double seconds = seconds_of_run(stage, registry, daemons, hosts, round);
        std::printf("  table3.real: %.2f s of work, %.2f processors\n", work, capacity());
        efficiency.push_back(work / (capacity() * seconds));
        by_itself.push_back(work / (capacity() * seconds_laid_out_by_itself(daemons, of_pixel, round, folder)));
    }
    figure(name, efficiency, 0.9, true);
    figure("table3.auto", by_itself, 0.85, true);
}

}  // namespace lightnet::bench
