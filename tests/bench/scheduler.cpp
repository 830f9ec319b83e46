// A master and ten thousand simulated workers, a million tiles: how much of a processor the decisions take, and whether
// the same seed gives the same story.
#include <cstdio>
#include <exception>

#include "tests/bench/figure.hpp"
#include "tests/run/simulator.hpp"

namespace lightnet::bench {
namespace {

test::World large(std::uint64_t seed, std::size_t tiles) {
    test::World world{.seed = seed, .hosts = 10000, .places_per_host = 1, .tiles = tiles};
    world.twice = 0.01, world.loss = 0.0001, world.deaths = 2e-6, world.drains = 2e-6, world.hangs = 1e-5;
    world.most_events = 100'000'000;
    return world;
}

const int rounds = repeated(3);

void check(bool good, const char* what) {
    if (!good) throw std::runtime_error(what);
}

double seconds_of_a_million() {
    const std::size_t tiles = sized<std::size_t>(1'000'000, 20'000);
    auto world = large(1, tiles);
    world.remember = false;
    const double begun = thread_seconds();
    const auto told = test::play(world);
    const double seconds = thread_seconds() - begun;
    check(told.folded.size() + told.set_aside.size() == tiles, "tiles are missing");
    for (const auto& [tile, times] : told.folded) check(times == 1, "a tile came twice");
    std::printf(
        "  %zu events, %llu doubled, %llu overdue, %llu asked again, %zu set aside; %.2f microseconds per tile\n",
        told.events, static_cast<unsigned long long>(told.counters.doubled),
        static_cast<unsigned long long>(told.counters.overdue),
        static_cast<unsigned long long>(told.counters.asked_again), told.set_aside.size(),
        1e6 * seconds / static_cast<double>(tiles));
    return seconds;
}

void measure() {
    std::vector<double> seconds;
    for (int round = 0; round < rounds; ++round) seconds.push_back(seconds_of_a_million());
    print_figure("scheduler.cpu", seconds, {"s", ""}, 60, false);

    int same = 0;
    const int seeds = repeated(5);
    for (int seed = 1; seed <= seeds; ++seed) {
        const auto once_more = large(static_cast<std::uint64_t>(seed), sized<std::size_t>(50000, 5000));
        same += test::play(once_more).story == test::play(once_more).story;
    }
    figure("scheduler.replay", {same / static_cast<double>(seeds)}, 1, true);
}

}  // namespace
}  // namespace lightnet::bench

int main() {
    return lightnet::bench::run("scheduler", [&] { lightnet::bench::measure(); });
}
