// What --verify costs: a picture on two daemons of which a part of all tiles is rendered by both, beside the same on
// the same two without.
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "nodes/standard_nodes.hpp"
#include "tests/bench/figure.hpp"
#include "tests/bench/stage.hpp"
#include "transport/start/local_workers.hpp"

namespace lightnet::bench {
namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t part = 20'000;  // millionths

void measure(const Registry& registry, const char* name, const char* graph, const char* samples) {
    const int rounds = repeated(9);
    Stage stage(registry, graph, {{"samples", samples}});
    LocalWorkers workers(LIGHTNET_STARTS_LIGHTNETD, 2, 1);
    std::uint64_t run = 0;
    const auto seconds = [&](std::uint32_t millionths) {
        stage.verify(millionths);
        Cluster cluster(stage.options(workers.endpoints(), ++run));
        const std::atomic<bool> never{false};
        cluster.gather(20s, never);
        cluster.adopt(cluster.plan());
        const double took = stage.on(cluster, run).seconds;
        cluster.finish();
        return took;
    };
    seconds(0);  // which brings the scene
    std::vector<double> more;
    for (int round = 0; round < rounds; ++round) {
        // Each goes first in turn, so that a machine that gets slower or faster favours neither.
        double without = 0, with = 0;
        for (int turn = 0; turn < 2; ++turn)
            if ((turn + round) % 2 == 0)
                without = seconds(0);
            else
                with = seconds(part);
        std::printf("  %s: %.3f s without, %.3f s with\n", name, without, with);
        more.push_back(with / without - 1);
    }
    figure(name, more, part * 1e-6 + 0.002, false);
}

}  // namespace
}  // namespace lightnet::bench

int main() {
    namespace bench = lightnet::bench;
    return bench::run("verify", [] {
        const lightnet::Registry registry{lightnet::standard_nodes()};
        bench::measure(registry, "verify.picture", "path_all.lua", bench::sized("256", "1"));
    });
}
