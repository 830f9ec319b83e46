// The paper's Table 2: the same renderer on more and more places. Real costs on two places are beside two independent
// serial runs (the figures of `overhead` as well); costs that are emulated by waiting show 8, 32 and 128 places.
#include <atomic>
#include <cstdio>
#include <optional>
#include <string>
#include <thread>

#include "core/readers/read_scene.hpp"
#include "nodes/standard_nodes.hpp"
#include "tests/bench/emulated.hpp"
#include "tests/bench/figure.hpp"
#include "tests/bench/overhead.hpp"
#include "transport/cluster.hpp"
#include "transport/local_workers.hpp"

namespace lightnet::bench {
namespace {

using namespace std::chrono_literals;

void measure_emulated(std::uint32_t places) {
    constexpr double milliseconds = 100;
    constexpr std::size_t each = 20;
    std::vector<double> efficiency;
    for (int round = 0; round < 3; ++round)
        efficiency.push_back(each * milliseconds * 1e-3 / seconds_of_places(places, milliseconds, each));
    const auto name = "table2.emulated" + std::to_string(places);
    show(name.c_str(), efficiency);
    figure(name.c_str(), median(efficiency), 0.95, true);
}

// From nothing to two daemons that are ready, less the time that reading and building the scene takes here.
void measure_set_up(const Picture& picture, const Registry& registry) {
    std::vector<double> extra;
    for (int round = 0; round < 5; ++round) {
        const double loading = seconds_of([&] {
            DiskFiles files;
            build_network(picture.job, registry, LoadedScene{read_scene(files, picture.job.scene)});
        });
        std::optional<LocalWorkers> workers;
        std::optional<Cluster> cluster;
        const double all = seconds_of([&] {
            workers.emplace(LIGHTNET_DAEMON, 2, 1);
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
    show("table2.setup, seconds beyond loading the scene", extra);
    std::printf("table2.setup %.2f s <=1 s %s\n", median(extra), median(extra) <= 1 ? "ok" : "short");
}

}  // namespace
}  // namespace lightnet::bench

int main(int argc, char** argv) {
    namespace bench = lightnet::bench;
    const std::string only = argc > 1 ? argv[1] : "";
    return lightnet::bench::run("table2", [&] {
        if (only.empty() || only == "emulated")
            for (const std::uint32_t places : {8, 32, 128}) bench::measure_emulated(places);
        if (only == "emulated") return;
        const lightnet::Registry registry{lightnet::standard_nodes()};
        const bench::Picture picture(registry, 256, 32);
        bench::measure_set_up(picture, registry);
        bench::measure_threads(picture, registry, "table2.threads");
        bench::measure_network(picture, registry, "table2.network");
    });
}
