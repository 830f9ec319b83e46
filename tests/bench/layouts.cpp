// Layouts that are found against all that there are, against HEFT, the paper's by hand and the best of a hundred by
// chance. All are played by forecast(), so this judges the choice, not the forecast.
//
// Arguments: the seed of the first of twenty cases; without one, it follows from the commit; `tuning` are those by
// which the choice was made what it is. `large`: cases of up to four operators on four hosts, which take hours.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "core/base/math/random.hpp"
#include "tests/bench/figure.hpp"
#include "tests/bench/layout_rivals.hpp"
#include "tests/run/all_layouts.hpp"
#include "tests/run/moving_world.hpp"

namespace lightnet::bench {
namespace {

using namespace test;

using Sizes = std::vector<std::pair<std::size_t, std::size_t>>;  // operators, hosts
const Sizes usual_sizes{{2, 3}, {3, 2}, {4, 2}, {3, 3}, {2, 4}}, large_sizes{{4, 3}, {3, 4}, {4, 4}};

// Is it what its seed is for? Every second lacks memory, every third spends three tenths of its work on preparing;
// every third has slow lines whatever the network.
bool is_meant(const LayoutCase& made, std::uint64_t seed) {
    const std::vector<bool> all(made.costs.nodes.size(), true);
    if (seed % 2 == 0 && has_room(made.costs, made.hosts.front(), all)) return false;
    const auto work = work_by_node(made.costs);
    const double rendering = std::accumulate(work.begin(), work.end(), 0.0);
    double preparing = 0;
    for (const auto& node : made.costs.nodes) preparing += node.preparing.shard_seconds + node.preparing.own_seconds;
    return seed % 3 != 1 || preparing >= 0.3 * (preparing + rendering);
}

// The first of its kind from that seed on.
LayoutCase case_of(std::uint64_t& seed, std::pair<std::size_t, std::size_t> size) {
    for (;; seed += 6)
        if (auto made = LayoutDice(seed).roll(size.first, size.second); is_meant(made, seed)) return made;
}

// The same with other costs, as a rehearsal might have taken them: each node's is up to three times too much or too
// little. `truth`: what each takes beside that.
LaidOut mistaken(const LayoutCase& made, std::uint64_t seed, std::vector<double>& truth) {
    std::mt19937_64 random(seed);
    LaidOut by{made.costs, made.hosts, launcher, {}};
    for (auto& node : by.costs.nodes) {
        truth.push_back(std::exp2(std::uniform_real_distribution(-1.6, 1.6)(random)));
        node.seconds /= truth.back();
    }
    by.holds = place_nodes(by.costs, by.hosts, launcher).holds;
    by.costs.picture.samples = 1 << 20;  // no end is near
    return by;
}

// The best layout of a long run that has prepared, over the one after the first move, which follows from what is
// measured while it renders.
double best_of_moved(const LayoutCase& made, std::uint64_t seed) {
    std::vector<double> truth;
    const auto by = mistaken(made, seed, truth);
    MovingWorld world(by, [](std::size_t, double) { return 1.0; });
    world.truth = truth;
    while (world.moves().empty() && world.now() < 20) world.run(world.now() + 0.1);
    LayoutCase later = made;
    later.costs.picture.samples *= 4;
    for (auto& node : later.costs.nodes) node.preparing = {};
    const double moved = seconds_of(later, world.mover().by().holds);
    return std::min(1.0, AllLayouts(later).best(moved).seconds / moved);
}

// Of one look at a run on 64 hosts that one of 29 operators holds up.
double milliseconds_of_a_decision() {
    auto made = LayoutDice(8).roll(29, 64);
    LaidOut by{made.costs, made.hosts, launcher, place_nodes(made.costs, made.hosts, launcher).holds};
    by.costs.picture.samples = 1 << 20;
    MovingWorld world(by, [](std::size_t host, double now) { return host % 9 == 0 && now > 1 ? 0.05 : 1.0; });
    world.run(1);
    const double before = process_seconds();
    int looks = 0;
    for (; looks < 8; ++looks) world.run(world.now() + 0.1);
    return 1000 * (process_seconds() - before) / looks;
}

/// Seconds of a case.
struct Played {
    double ours, best, heft, hand, chance;
    double others() const { return std::min({heft, hand, chance}); }
};

Played play(const LayoutCase& made, std::uint64_t seed) {
    const auto of = [&](const HeldByHosts& holds) {
        return !holds.empty() && covers(made, holds) ? seconds_of(made, holds)
                                                     : std::numeric_limits<double>::infinity();
    };
    Played played{};
    played.ours = of(place_nodes(made.costs, made.hosts, launcher).holds);
    played.heft = of(Heft(made).layout()), played.hand = of(layout_by_hand(made));
    played.chance = best_by_chance(made, seed);
    played.best = std::min(played.ours, played.others());
    played.best = std::min(played.best, AllLayouts(made).best(played.best).seconds);
    return played;
}

void measure(std::uint64_t first_seed, const Sizes& sizes, std::size_t cases) {
    std::vector<double> of_all, of_others, moved;
    for (std::size_t i = 0; i < cases; ++i) {
        std::uint64_t seed = first_seed + i;
        const auto size = sizes[i % sizes.size()];
        const auto made = case_of(seed, size);
        const auto played = play(made, seed);
        moved.push_back(best_of_moved(made, seed));
        std::printf(
            "  layouts: seed %llu, %zu operators, %zu hosts: %.2f s; the best of all %.2f, HEFT %.2f, by hand "
            "%.2f, by chance %.2f; moved, %.0f %% of the best\n",
            static_cast<unsigned long long>(seed), size.first, size.second, played.ours, played.best, played.heft,
            played.hand, played.chance, 100 * moved.back());
        std::fflush(stdout);
        of_all.push_back(played.best / played.ours);
        of_others.push_back(played.others() / played.ours);
    }
    const auto least = [](const std::vector<double>& of) { return *std::min_element(of.begin(), of.end()); };
    figure("layouts.of_best", of_all, 0.95, true);
    figure("layouts.least", {least(of_all)}, 0.85, true);
    figure("layouts.of_others", {least(of_others)}, 0.9, true);
    figure("layouts.after_move", moved, 0.95, true);
    figure("layouts.after_move_least", {least(moved)}, 0.85, true);
    quantity("layouts.decision", {milliseconds_of_a_decision()}, "ms", 50, false);
}

// Follows from the commit, so that nobody can choose what pleases them. A multiple of six: the mix of cases is the same
// for every commit.
std::uint64_t seed_of_commit() {
    const char* const commit = std::getenv("LIGHTNET_BENCH_COMMIT");
    return (key_of(commit && *commit ? commit : "no commit") >> 24) / 6 * 6;
}

}  // namespace
}  // namespace lightnet::bench

int main(int argc, char** argv) {
    using namespace lightnet::bench;
    return run("layouts", [&] {
        std::uint64_t seed = seed_of_commit();
        bool large = false;
        for (const std::string& word : std::vector<std::string>(argv + 1, argv + argc))
            if (word == "large")
                large = true;
            else
                seed = word == "tuning" ? 0 : std::stoull(word, nullptr, 0);
        measure(seed, large ? large_sizes : usual_sizes, large ? 6 : sized<std::size_t>(20, 1));
    });
}
