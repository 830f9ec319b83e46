// Two places, in threads and in daemons, beside two independent serial runs of half the work each.
#include <atomic>
#include <chrono>
#include <thread>

#include "core/run/place/place.hpp"
#include "tests/bench/figure.hpp"
#include "tests/bench/overhead.hpp"
#include "transport/launcher/cluster.hpp"
#include "transport/launcher/threaded_run.hpp"
#include "transport/start/local_workers.hpp"

namespace lightnet::bench {
namespace {

using namespace std::chrono_literals;

constexpr std::uint64_t run_id = 1;
const int rounds = repeated(9);

void measure_efficiency(const char* name, const Picture& picture, Carrier& carrier, const Plan& plan) {
    // The carrier is looked after all the time, or the hosts would think that their launcher is gone.
    const auto look_after = [&] {
        carrier.wait(20ms);
        carrier.receive();
    };
    std::vector<double> efficiency;
    for (int round = 0; round < rounds; ++round) {
        const double independent = seconds_of_independent_halves(picture, look_after);
        const double together = seconds_of_master(picture, run_id, carrier, plan);
        efficiency.push_back(independent / together);
    }
    figure(name, efficiency, 0.97, true);
}

}  // namespace

void measure_threads(const Picture& picture, const Registry& registry, const char* name) {
    const Plan two = plan(picture.job.graph, registry, {}, {{"", 2}});
    ThreadedRun run(picture.network, run_id, two, picture.job.tuning);
    measure_efficiency(name, picture, run.carrier(), two);
    run.stop();
}

void measure_network(const Picture& picture, const Registry& registry, const char* name) {
    const LocalWorkers workers(LIGHTNET_STARTS_LIGHTNETD, 2, 1);
    Cluster::Options options;
    options.run = run_id;
    options.job = picture.job;
    options.files = picture.files;
    options.endpoints = workers.endpoints();
    options.plan = [&](const std::vector<HostOffer>& offers) { return plan(picture.job.graph, registry, {}, offers); };
    Cluster cluster(std::move(options));
    const std::atomic<bool> never{false};
    cluster.gather(5s, never);
    cluster.adopt(cluster.plan());
    measure_efficiency(name, picture, cluster, cluster.plan());
    cluster.finish();
}

}  // namespace lightnet::bench
