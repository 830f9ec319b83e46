// Layouts against all others that there are, in random cases where hosts lack memory.
#include "core/run/forecast/placement.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "core/base/error.hpp"
#include "core/run/forecast/forecast.hpp"
#include "core/run/forecast/place_work.hpp"

namespace lightnet::placement_test {
namespace {

constexpr LineCost launcher{1.25e8, 2e-4};

struct Case {
    RunCosts costs;
    std::vector<ForecastHost> hosts;
};

/// Networks and hosts by a seed: half of the cases lack memory, a third have slow lines, a third prepare much.
class Dice {
public:
    explicit Dice(std::uint64_t seed) : seed_(seed), random_(seed * 7919 + 13) {}

    Case roll(std::size_t operators, std::size_t hosts) {
        Case made;
        network(made.costs, operators);
        for (std::size_t host = 0; host < hosts; ++host) made.hosts.push_back(this->host(host));
        if (seed_ % 2 == 0) lack_memory(made);
        return made;
    }

private:
    double part() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
    double between(double least, double most) { return least * std::pow(most / least, part()); }
    std::size_t one_of(std::size_t count) {
        return std::min(count - 1, static_cast<std::size_t>(part() * double(count)));
    }

    // Each asks some of those before it, the last is the renderer.
    void network(RunCosts& costs, std::size_t operators) {
        const bool prepares_much = seed_ % 3 == 1;
        for (std::size_t node = 0; node <= operators; ++node) {
            const bool image = node == operators;
            costs.nodes.push_back({image ? "image" : "op" + std::to_string(node), image ? 0.02 : between(2e-6, 4e-5)});
            costs.order.push_back(node);
            for (std::size_t to = 0; to < node; ++to)
                if (to + 1 == node || part() < 0.5)
                    costs.edges.push_back({node, to, image ? 2000 : between(0.3, 1.5), 60});
            if (image || part() < 0.4) continue;
            auto& preparing = costs.nodes[node].preparing;
            preparing = {
                .shards = 60, .shard_seconds = between(0.5, 3), .own_seconds = between(0.02, 0.2), .bytes = 1e6};
            if (prepares_much) preparing.shard_seconds *= 6, preparing.own_seconds *= 6;
            costs.nodes[node].memory = between(1e8, 4e9);
        }
        costs.image = operators;
        costs.picture = {320, 160, 16, 16};
    }

    ForecastHost host(std::size_t number) {
        ForecastHost host{.name = "host" + std::to_string(number), .places = std::uint32_t(1 + one_of(3))};
        host.speed = std::exp2(double(one_of(4)));
        if (seed_ % 3 == 0) host.line = part() < 0.5 ? LineCost{1.25e7, 1e-3} : LineCost{1.25e8, 5e-3};
        return host;
    }

    // No host has room for all; one has for all but the smallest, and another for that.
    void lack_memory(Case& made) {
        double all = 0, least = 1e18;
        for (const auto& node : made.costs.nodes) {
            all += node.memory;
            if (node.memory > 0) least = std::min(least, node.memory);
        }
        if (all <= 0) return;
        for (auto& host : made.hosts) host.memory = std::max(1.0, (0.3 + 0.6 * part()) * all - 1);
        const auto first = one_of(made.hosts.size());
        made.hosts[first].memory = std::max(1.001 * (all - least), 1.01 * least);
        auto& second = made.hosts[(first + 1) % made.hosts.size()].memory;
        second = std::max(second, 1.01 * least);
    }

    std::uint64_t seed_;
    std::mt19937_64 random_;
};

double seconds_of(const Case& made, const HeldByHosts& holds) {
    const auto found = forecast(made.costs, plan_of(holds, made.hosts), made.hosts, launcher, 1);
    return found.prepare + found.render;
}

bool covers(const Case& made, const HeldByHosts& holds) {
    return std::all_of(made.costs.order.begin(), made.costs.order.end(), [&](auto node) {
        return std::any_of(holds.begin(), holds.end(), [&](const auto& host) { return host[node]; });
    });
}

// The least seconds of all layouts that fit.
double best_of_all(const Case& made) {
    const std::size_t nodes = made.costs.nodes.size(), sets = std::size_t{1} << nodes;
    std::size_t layouts = 1;
    for (std::size_t host = 0; host < made.hosts.size(); ++host) layouts *= sets;
    double least = std::numeric_limits<double>::infinity();
    HeldByHosts holds(made.hosts.size(), std::vector<bool>(nodes));
    for (std::size_t layout = 0; layout < layouts; ++layout) {
        bool fits = true;
        for (std::size_t host = 0, rest = layout; host < made.hosts.size(); ++host, rest /= sets) {
            for (std::size_t node = 0; node < nodes; ++node) holds[host][node] = rest % sets >> node & 1;
            fits = fits && has_room(made.costs, made.hosts[host], holds[host]);
        }
        if (fits && covers(made, holds)) least = std::min(least, seconds_of(made, holds));
    }
    return least;
}

// The seconds of the best of all layouts, over those of ours: the least and the median of cases that lack memory, with
// every second seed.
struct Found {
    double least, median;
};
Found compare_with_all(std::uint64_t first_seed, std::size_t cases, std::size_t operators, std::size_t hosts) {
    std::vector<double> parts;
    for (std::uint64_t seed = first_seed; parts.size() < cases; seed += 2) {
        const auto made = Dice(seed).roll(operators, hosts);
        if (has_room(made.costs, made.hosts.front(), std::vector<bool>(operators + 1, true))) continue;
        const auto ours = place_nodes(made.costs, made.hosts, launcher);
        parts.push_back(best_of_all(made) / seconds_of(made, ours.holds));
        testing::Test::RecordProperty("seed" + std::to_string(seed), std::to_string(parts.back()));
    }
    std::sort(parts.begin(), parts.end());
    return {parts.front(), parts[parts.size() / 2]};
}

#ifndef LIGHTNET_LARGE

TEST(Placement, ComesNearTheBestWhereMemoryLacks) {
    const auto found = compare_with_all(1000, 4, 2, 2);
    EXPECT_GE(found.least, 0.6);
    EXPECT_GE(found.median, 0.95);
}

TEST(Placement, PutsEverythingEverywhereUnlessThatIsMuchSlower) {
    for (const std::uint64_t seed : {5, 11}) {
        const auto made = Dice(seed).roll(2, 3);
        const auto layout = place_nodes(made.costs, made.hosts, launcher);
        const HeldByHosts everywhere(3, std::vector<bool>(3, true));
        if (layout.holds == everywhere) continue;
        EXPECT_LT(seconds_of(made, layout.holds), 0.9 * seconds_of(made, everywhere)) << seed;
    }
}

TEST(Placement, KeepsToTheMemoryOfHosts) {
    for (std::uint64_t seed = 2; seed <= 30; seed += 2) {
        const auto made = Dice(seed).roll(7, 9);
        const auto layout = place_nodes(made.costs, made.hosts, launcher);
        EXPECT_TRUE(covers(made, layout.holds)) << seed;
        for (std::size_t host = 0; host < made.hosts.size(); ++host)
            EXPECT_TRUE(has_room(made.costs, made.hosts[host], layout.holds[host])) << seed;
        EXPECT_FALSE(layout.why.empty());
    }
}

TEST(Placement, IsTheSameEachTime) {
    const auto made = Dice(4).roll(2, 3);
    EXPECT_EQ(place_nodes(made.costs, made.hosts, launcher).holds, place_nodes(made.costs, made.hosts, launcher).holds);
}

TEST(Placement, HasWhatANodeTakesBesideIt) {
    auto made = Dice(6).roll(4, 9);
    made.costs.beside = {{3, 0}};
    for (const auto& host : place_nodes(made.costs, made.hosts, launcher).holds) EXPECT_TRUE(!host[3] || host[0]);
}

TEST(Placement, LaysThirtyNodesOutOnSixtyFourHosts) {
    const auto made = Dice(8).roll(29, 64);
    EXPECT_TRUE(covers(made, place_nodes(made.costs, made.hosts, launcher).holds));
}

TEST(Placement, SaysWhatFitsNowhere) {
    auto made = Dice(4).roll(3, 2);
    made.costs.nodes[0].memory = 1e12;
    for (auto& host : made.hosts) host.memory = 1e9;
    try {
        place_nodes(made.costs, made.hosts, launcher);
        FAIL() << "a node of a terabyte has no place";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("'op0'"), std::string::npos) << error.what();
    }
}

TEST(Placement, IsSaidAsAHostsFileDoes) {
    const auto made = Dice(3).roll(2, 2);
    HeldByHosts holds(2, std::vector<bool>(3, true));
    holds[1][0] = false;
    const auto said = hosts_of(holds, made.costs, made.hosts, {});
    ASSERT_EQ(said.hosts.size(), 2u);
    EXPECT_TRUE(said.hosts[0].replicas.empty());
    const int places = static_cast<int>(made.hosts[1].places);
    EXPECT_EQ(said.hosts[1].replicas, (std::map<std::string, int>{{"op1", places}, {"image", places}}));
}

#else

TEST(PlacementLarge, ComesNearTheBestWhereMemoryLacks) {
    const auto found = compare_with_all(1000, 10, 2, 3);
    EXPECT_GE(found.least, 0.6);
    EXPECT_GE(found.median, 0.95);
}

#endif

}  // namespace
}  // namespace lightnet::placement_test
