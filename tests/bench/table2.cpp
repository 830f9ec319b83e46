// The paper's Table 2: the same renderer on more and more places. Real costs on two places, over inproc and over tcp,
// are beside two independent serial runs (the figures of `overhead` as well); costs that are emulated by waiting show
// 8, 32 and 128 places: threads of this process, and daemons that are each a host of their own (namespaces.sh), over
// tcp. The paper's own network and hosts are as shipped. Arguments: paper, emulated, setup, threads, network; without
// any, all of them.
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/readers/read_scene.hpp"
#include "nodes/standard_nodes.hpp"
#include "tests/bench/emulated.hpp"
#include "tests/bench/figure.hpp"
#include "tests/bench/overhead.hpp"
#include "tests/bench/paper.hpp"
#include "transport/launcher/cluster.hpp"
#include "transport/start/child.hpp"
#include "transport/start/local_workers.hpp"

namespace lightnet::bench {
namespace {

using namespace std::chrono_literals;

const int rounds = repeated(3);
const double milliseconds = sized(100.0, 10.0);       // per tile
const std::size_t tiles = sized<std::size_t>(20, 2);  // of each place
const double ideal = tiles * milliseconds * 1e-3;

void measure_emulated(std::uint32_t places) {
    std::vector<double> efficiency;
    for (int round = 0; round < rounds; ++round)
        efficiency.push_back(ideal / seconds_of_places(places, milliseconds, tiles));
    figure("table2.emulated" + std::to_string(places), efficiency, 0.95, true);
}

// The paper's hosts and network, eight renderers and six times the lighting: costs emulated by waiting.
void measure_paper() {
    const EmulatedCosts costs{{{"image", 30}, {"soft", 30}, {"direct", 10}}, 256};
    figure("table2.paper", emulated_efficiency("figure3", "table2", {4, 2, 1, 1}, costs, sized<std::size_t>(600, 20)),
           0.95, true);
}

// What this program does in a host of its own: `words` are the number of places and the endpoints of the others.
void ask_hosts(const std::vector<std::string>& words) {
    const Registry registry{standard_nodes()};
    const Picture picture(registry, 64, 16);
    const std::vector<std::string> endpoints(words.begin() + 1, words.end());
    for (int round = 0; round < rounds; ++round)
        std::printf("%.6f\n", ideal / seconds_of_hosts(endpoints, picture, std::stoul(words[0]), milliseconds, tiles));
}

void measure_emulated_hosts(const char* program, std::uint32_t hosts, std::uint32_t places_each) {
    const auto places = std::to_string(hosts * places_each);
    const auto name = "table2.emulated" + places + "_tcp";
    const auto output =
        run_program({LIGHTNET_SOURCE_DIR "/tests/bench/namespaces.sh", std::to_string(hosts),
                     std::to_string(places_each), LIGHTNET_STARTS_EMULATED_DAEMON, program, "ask", places},
                    "", 3min);
    constexpr int no_hosts = 77;
    if (output.code == no_hosts) return not_run(name, output.text.substr(0, output.text.find('\n')));
    if (output.code != 0) throw std::runtime_error(name + ": " + output.text);
    std::istringstream lines(output.text);
    std::vector<double> efficiency;
    for (double one = 0; lines >> one;) efficiency.push_back(one);
    std::printf("  %s: %u hosts of %u places\n", name.c_str(), hosts, places_each);
    figure(name, efficiency, 0.95, true);
}

// From nothing to two daemons that are ready, less the time that reading and building the scene takes here.
void measure_set_up(const Picture& picture, const Registry& registry) {
    std::vector<double> extra;
    for (int round = 0; round < repeated(5); ++round) {
        const double loading = seconds_of([&] {
            DiskFiles files;
            build_network(picture.job, registry, LoadedScene{read_scene(files, picture.job.scene)});
        });
        std::optional<LocalWorkers> workers;
        std::optional<Cluster> cluster;
        const double all = seconds_of([&] {
            workers.emplace(LIGHTNET_STARTS_LIGHTNETD, 2, 1);
            Cluster::Options options;
            options.run = 1;
            options.job = picture.job;
            options.files = picture.files;
            options.endpoints = workers->endpoints();
            options.plan = [&](const std::vector<HostOffer>& offers) {
                return plan(picture.job.graph, registry, {}, offers);
            };
            cluster.emplace(std::move(options));
            const std::atomic<bool> never{false};
            cluster->gather(5s, never);
        });
        cluster->finish();
        extra.push_back(all - loading);
    }
    print_figure("table2.setup", extra, {"s", "", 1, 2}, 1, false);
}

}  // namespace
}  // namespace lightnet::bench

int main(int argc, char** argv) {
    namespace bench = lightnet::bench;
    const std::vector<std::string> words(argv + 1, argv + argc);
    const auto wanted = [&](const char* name) {
        return words.empty() || std::find(words.begin(), words.end(), name) != words.end();
    };
    return lightnet::bench::run("table2", [&] {
        if (!words.empty() && words[0] == "ask") return bench::ask_hosts({words.begin() + 1, words.end()});
        if (wanted("paper")) bench::measure_paper();
        if (wanted("emulated")) {
            for (const std::uint32_t places : {8, 32, 128}) bench::measure_emulated(places);
            bench::measure_emulated_hosts(argv[0], 8, 1);
            bench::measure_emulated_hosts(argv[0], 32, 1);
            bench::measure_emulated_hosts(argv[0], 32, 4);
        }
        const lightnet::Registry registry{lightnet::standard_nodes()};
        const bench::Picture picture(registry, bench::sized(256u, 64u), bench::sized(32u, 1u));
        if (wanted("setup")) bench::measure_set_up(picture, registry);
        if (wanted("threads")) bench::measure_threads(picture, registry, "table2.threads");
        if (wanted("network")) bench::measure_network(picture, registry, "table2.network");
    });
}
