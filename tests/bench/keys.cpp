// What keys cost: the carrier between hosts that know each other by keys, beside plain ZeroMQ that encrypts as many
// bytes (CURVE, too); and a picture on two daemons with keys, beside the same on two without.
#include <atomic>
#include <chrono>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "nodes/standard_nodes.hpp"
#include "tests/bench/asking.hpp"
#include "tests/bench/figure.hpp"
#include "tests/bench/stage.hpp"
#include "tests/bench/two_hosts.hpp"
#include "transport/start/local_workers.hpp"

namespace lightnet::bench {
namespace {

using namespace std::chrono_literals;

void measure_carrier(const Picture& picture) {
    const Registry kinds = asking_kinds();
    TwoHosts hosts(kinds, picture, asking_run, asking_job(picture), one_asks_the_other, KeyPair::random());
    measure_asking(hosts.cluster(), hosts.cluster().plan(), [](std::size_t) { return "tcp://127.0.0.1:*"; },
                   {{"keys.carrier", PlainLoad::packets, PlainLine::with_keys, true}});
    hosts.cluster().finish();
}

/// A picture on two daemons of one place each, over and over.
class Farm {
public:
    Farm(Stage& stage, const KeyPair& launcher, bool with_keys)
        : stage_(stage),
          launcher_(launcher),
          workers_(LIGHTNET_STARTS_LIGHTNETD, 2, 1,
                   with_keys ? std::optional(LocalWorkers::Keys{own_, launcher.open}) : std::nullopt),
          with_keys_(with_keys) {}

    double seconds() {
        auto options = stage_.options(workers_.endpoints(), ++run_);
        if (with_keys_) {
            options.key = launcher_;
            for (const auto& endpoint : workers_.endpoints()) options.host_keys[endpoint] = own_.open;
        }
        Cluster cluster(std::move(options));
        const std::atomic<bool> never{false};
        cluster.gather(20s, never);
        cluster.adopt(cluster.plan());
        const double seconds = stage_.on(cluster, run_).seconds;
        cluster.finish();
        return seconds;
    }

private:
    Stage& stage_;
    KeyPair launcher_, own_ = KeyPair::random();
    LocalWorkers workers_;
    bool with_keys_;
    std::uint64_t run_ = 0;
};

void measure_picture(const Registry& registry, const char* name, const char* graph, const char* samples) {
    const int rounds = repeated(9);
    Stage stage(registry, graph, {{"samples", samples}});
    const auto launcher = KeyPair::random();
    Farm open(stage, launcher, false), keyed(stage, launcher, true);
    std::vector<double> more;
    open.seconds(), keyed.seconds();  // which bring the scene
    for (int round = 0; round < rounds; ++round) {
        // Each goes first in turn, so that a machine that gets slower or faster favours nobody.
        double without = 0, with = 0;
        for (int turn = 0; turn < 2; ++turn)
            if ((turn + round) % 2 == 0)
                without = open.seconds();
            else
                with = keyed.seconds();
        std::printf("  %s: %.3f s without keys, %.3f s with\n", name, without, with);
        more.push_back(with / without - 1);
    }
    figure(name, more, 0.01, false);
}

}  // namespace
}  // namespace lightnet::bench

int main(int argc, char** argv) {
    namespace bench = lightnet::bench;
    const std::string only = argc > 1 ? argv[1] : "";
    return bench::run("keys", [&] {
        const lightnet::Registry registry{lightnet::standard_nodes()};
        if (only.empty() || only == "carrier") bench::measure_carrier(bench::Picture(registry, 128, 16));
        if (only.empty() || only == "picture") {
            bench::measure_picture(registry, "keys.picture_path", "path_all.lua", bench::sized("64", "1"));
            bench::measure_picture(registry, "keys.picture_cache", "irradiance_cache.lua", bench::sized("256", "1"));
        }
    });
}
