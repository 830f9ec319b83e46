// Layouts that are found against all that there are, against HEFT and against the best of a hundred by chance, in
// random cases whose hosts lack memory. All are played by forecast(), so this judges the choice, not the forecast.
//
// Argument: an even seed; without it, one that follows from the commit.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "core/base/math/random.hpp"
#include "core/run/forecast/place_work.hpp"
#include "tests/bench/figure.hpp"
#include "tests/run/layout_cases.hpp"
#include "tests/run/moving_world.hpp"

namespace lightnet::bench {
namespace {

using namespace test;

/// Heterogeneous Earliest Finish Time (Topcuoglu et al. 2002): each node on the one host on which it would end first,
/// the nodes by how much work follows from them. Memory is what hosts have of it.
class Heft {
public:
    explicit Heft(const LayoutCase& made) : made_(made), work_(work_by_node(made.costs)) {
        const auto blocks = usual_blocks(made.costs.picture);
        questions_ = questions_of_block(made.costs);
        for (auto& count : questions_) count *= blocks;
        for (std::size_t node = 0; node < work_.size(); ++node) {
            const auto& preparing = made.costs.nodes[node].preparing;
            work_[node] += preparing.shard_seconds + preparing.own_seconds;
        }
    }

    HeldByHosts layout() {
        const auto& costs = made_.costs;
        std::vector<double> rank(work_.size(), 0);
        for (const auto node : costs.order) {
            for (const auto& edge : costs.edges)
                if (edge.from == node) rank[node] = std::max(rank[node], way(edge, mean_line()) + rank[edge.to]);
            rank[node] += work_[node] / mean_power();
        }
        auto order = costs.order;
        std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return rank[a] > rank[b]; });
        HeldByHosts holds(made_.hosts.size(), std::vector<bool>(work_.size(), false));
        std::vector<double> free(made_.hosts.size(), 0), ended(work_.size(), 0);
        std::vector<std::size_t> at(work_.size(), 0);
        for (const auto node : order) {
            double first = std::numeric_limits<double>::infinity();
            for (std::size_t host = 0; host < made_.hosts.size(); ++host) {
                auto held = holds[host];
                held[node] = true;
                if (!has_room(made_.costs, made_.hosts[host], held)) continue;
                double begin = free[host];
                for (const auto& edge : costs.edges)
                    if (edge.to == node && at[edge.from] != host)
                        begin = std::max(begin, ended[edge.from] + way(edge, made_.hosts[host].line));
                const double end = begin + work_[node] / (made_.hosts[host].places * made_.hosts[host].speed);
                if (end < first) first = end, at[node] = host;
            }
            if (first == std::numeric_limits<double>::infinity()) return {};
            holds[at[node]][node] = true;
            free[at[node]] = ended[node] = first;
        }
        return holds;
    }

private:
    double way(const EdgeCost& edge, const LineCost& line) const {
        return questions_[edge.from] * edge.questions * edge.bytes / line.bytes_per_second + line.seconds;
    }
    LineCost mean_line() const {
        LineCost mean{0, 0};
        for (const auto& host : made_.hosts) {
            mean.bytes_per_second += host.line.bytes_per_second / double(made_.hosts.size());
            mean.seconds += host.line.seconds / double(made_.hosts.size());
        }
        return mean;
    }
    double mean_power() const {
        double power = 0;
        for (const auto& host : made_.hosts) power += host.places * host.speed;
        return power / double(made_.hosts.size());
    }

    const LayoutCase& made_;
    std::vector<double> work_, questions_;
};

double best_by_chance(const LayoutCase& made, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    double least = std::numeric_limits<double>::infinity();
    for (int tries = 0, found = 0; found < 100 && tries < 100000; ++tries) {
        HeldByHosts holds(made.hosts.size(), std::vector<bool>(made.costs.nodes.size()));
        bool fits = true;
        for (std::size_t host = 0; host < holds.size(); ++host) {
            for (std::size_t node = 0; node < holds[host].size(); ++node) holds[host][node] = random() >> 40 & 1;
            fits = fits && has_room(made.costs, made.hosts[host], holds[host]);
        }
        if (!fits || !covers(made, holds)) continue;
        ++found;
        least = std::min(least, seconds_of(made, holds));
    }
    return least;
}

constexpr std::array<std::pair<std::size_t, std::size_t>, 4> sizes{
    {{2, 3}, {3, 2}, {4, 2}, {3, 3}}};  // operators, hosts

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

// The layout after moves that follow from what is measured while it renders.
HeldByHosts after_moves(const LayoutCase& made, std::uint64_t seed) {
    std::vector<double> truth;
    const auto by = mistaken(made, seed, truth);
    MovingWorld world(by, [](std::size_t, double) { return 1.0; });
    world.truth = truth;
    world.run(20);
    return world.mover().by().holds;
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

void measure(std::uint64_t first_seed, std::size_t cases) {
    std::vector<double> of_all, of_others, moved;
    for (std::uint64_t seed = first_seed; of_all.size() < cases; seed += 2) {
        const auto [operators, hosts] = sizes[of_all.size() % sizes.size()];
        const auto made = LayoutDice(seed).roll(operators, hosts);
        if (has_room(made.costs, made.hosts.front(), std::vector<bool>(made.costs.nodes.size(), true))) continue;
        const double ours = seconds_of(made, place_nodes(made.costs, made.hosts, launcher).holds);
        const double best = best_of_all(made), by_chance = best_by_chance(made, seed);
        const auto layout = Heft(made).layout();
        const double by_heft = layout.empty() ? std::numeric_limits<double>::infinity() : seconds_of(made, layout);
        std::printf(
            "  layouts: seed %llu, %zu operators, %zu hosts: %.2f s; the best %.2f, HEFT %.2f, by chance %.2f\n",
            static_cast<unsigned long long>(seed), operators, hosts, ours, best, by_heft, by_chance);
        std::fflush(stdout);
        of_all.push_back(best / ours);
        of_others.push_back(std::min(by_heft, by_chance) / ours);
        moved.push_back(best / seconds_of(made, after_moves(made, seed)));
    }
    figure("layouts.of_best", of_all, 0.95, true);
    figure("layouts.least", {*std::min_element(of_all.begin(), of_all.end())}, 0.85, true);
    figure("layouts.after_moves", moved, 0.85, true);
    quantity("layouts.decision", {milliseconds_of_a_decision()}, "ms", 50, false);
    figure("layouts.of_others", {*std::min_element(of_others.begin(), of_others.end())}, 0.9, true);
}

// Follows from the commit, so that nobody can choose what pleases them. Even: hosts lack memory.
std::uint64_t seed_of_commit() {
    const char* const commit = std::getenv("LIGHTNET_BENCH_COMMIT");
    return key_of(commit && *commit ? commit : "no commit") >> 24 << 1;
}

}  // namespace
}  // namespace lightnet::bench

int main(int argc, char** argv) {
    using namespace lightnet::bench;
    return run("layouts", [&] {
        measure(argc > 1 ? std::strtoull(argv[1], nullptr, 0) : seed_of_commit(), sized<std::size_t>(20, 1));
    });
}
