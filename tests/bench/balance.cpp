// Replicas of different speed: how near the makespan comes to the ideal, and what it costs when one becomes ten times
// slower in the middle. Costs are emulated by waiting.
// Figures: balance.tiles and balance.light, makespan over the ideal of speeds 1:2:4:8; balance.slowed, makespan with a
// replica that slows down over the one without.
#include <cstdio>
#include <exception>

#include "core/run/assembly/fingerprint.hpp"
#include "tests/bench/emulated.hpp"
#include "tests/bench/figure.hpp"
#include "transport/launcher/threaded_run.hpp"

namespace lightnet::bench {
namespace {

const int rounds = repeated(3);

std::shared_ptr<Slowness> speeds(std::vector<double> slowness) {
    auto speeds = std::make_shared<Slowness>();
    speeds->of_replica = std::move(slowness);
    return speeds;
}

// Four renderers; the slowest alone would take 48 s.
double tiles() {
    constexpr double milliseconds = 20;
    const std::size_t each = sized<std::size_t>(75, 5);
    const double ideal = 4 * each * milliseconds * 1e-3 / (1 + 0.5 + 0.25 + 0.125);
    return seconds_of_places(4, milliseconds, each, speeds({1, 2, 4, 8})) / ideal;
}

// One renderer asks four replicas of a light operator.
double light() {
    constexpr double microseconds = 25;
    const std::size_t tiles = sized<std::size_t>(400, 20);
    constexpr std::size_t questions = 256;
    constexpr std::uint64_t run_id = 1;
    const Registry kinds = emulated_kinds(speeds({1, 2, 4, 8}), "EmulatedLight");
    Job job;
    job.isa = usual_isa();
    job.graph.file = "balance.lua";
    job.graph.nodes = {emulated_light("light", microseconds), emulated_image(0, questions, {"light"})};
    const auto network = build_network(job, kinds, LoadedScene{});
    Plan plan{{{"", 0}, {"", 1}, {"", 2}, {"", 3}, {"", 4}}, {{1, 2, 3, 4}, {0}}};
    ThreadedRun run(network, run_id, plan, job.tuning);
    const double seconds = seconds_of_emulated(*network, run_id, run.carrier(), plan, tiles, 32);
    run.stop();
    const double ideal = tiles * questions * microseconds * 1e-6 / (1 + 0.5 + 0.25 + 0.125);
    return seconds / ideal;
}

double slowed() {
    constexpr double milliseconds = 10;
    const std::size_t each = sized<std::size_t>(150, 10);
    const double without = seconds_of_places(4, milliseconds, each);
    auto slowness = std::make_shared<Slowness>();
    slowness->slowed = 0;
    slowness->slowed_at += std::chrono::milliseconds(750);  // of 1500
    return seconds_of_places(4, milliseconds, each, slowness) / without;
}

void measure(const char* name, double (*ratio)(), double goal) {
    std::vector<double> ratios;
    for (int round = 0; round < rounds; ++round) ratios.push_back(ratio());
    figure(name, ratios, goal, false);
}

}  // namespace
}  // namespace lightnet::bench

int main() {
    namespace bench = lightnet::bench;
    return lightnet::bench::run("balance", [&] {
        bench::measure("balance.tiles", bench::tiles, 1.1);
        bench::measure("balance.light", bench::light, 1.1);
        bench::measure("balance.slowed", bench::slowed, 1.3);
    });
}
