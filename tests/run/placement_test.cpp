// Layouts against all others that there are, in random cases where hosts lack memory.
#include "core/run/forecast/placement.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/error.hpp"
#include "tests/run/layout_cases.hpp"

namespace lightnet::placement_test {
namespace {

using namespace test;

// The seconds of the best of all layouts, over those of ours: the least and the median of cases that lack memory, with
// every second seed.
struct Found {
    double least, median;
};
Found compare_with_all(std::uint64_t first_seed, std::size_t cases, std::size_t operators, std::size_t hosts) {
    std::vector<double> parts;
    for (std::uint64_t seed = first_seed; parts.size() < cases; seed += 2) {
        const auto made = LayoutDice(seed).roll(operators, hosts);
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
    EXPECT_GE(found.least, 0.85);
    EXPECT_GE(found.median, 0.95);
}

TEST(Placement, ChangesTwoHostsAtOnceWhereEachHasRoomForOneNode) {
    for (const std::uint64_t seed : {40, 86, 128}) {
        const auto made = LayoutDice(seed).roll(3, 2);
        const double ours = seconds_of(made, place_nodes(made.costs, made.hosts, launcher).holds);
        EXPECT_GT(best_of_all(made), 0.95 * ours) << seed;
    }
}

TEST(Placement, PutsEverythingEverywhereUnlessThatIsMuchSlower) {
    for (const std::uint64_t seed : {5, 11}) {
        const auto made = LayoutDice(seed).roll(2, 3);
        const auto layout = place_nodes(made.costs, made.hosts, launcher);
        const HeldByHosts everywhere(3, std::vector<bool>(3, true));
        if (layout.holds == everywhere) continue;
        EXPECT_LT(seconds_of(made, layout.holds), 0.9 * seconds_of(made, everywhere)) << seed;
    }
}

TEST(Placement, KeepsToTheMemoryOfHosts) {
    for (std::uint64_t seed = 2; seed <= 30; seed += 2) {
        const auto made = LayoutDice(seed).roll(7, 9);
        const auto layout = place_nodes(made.costs, made.hosts, launcher);
        EXPECT_TRUE(covers(made, layout.holds)) << seed;
        for (std::size_t host = 0; host < made.hosts.size(); ++host)
            EXPECT_TRUE(has_room(made.costs, made.hosts[host], layout.holds[host])) << seed;
        EXPECT_FALSE(layout.why.empty());
    }
}

TEST(Placement, IsTheSameEachTime) {
    const auto made = LayoutDice(4).roll(2, 3);
    EXPECT_EQ(place_nodes(made.costs, made.hosts, launcher).holds, place_nodes(made.costs, made.hosts, launcher).holds);
}

TEST(Placement, HasWhatANodeTakesBesideIt) {
    auto made = LayoutDice(6).roll(4, 9);
    made.costs.beside = {{3, 0}};
    for (const auto& host : place_nodes(made.costs, made.hosts, launcher).holds) EXPECT_TRUE(!host[3] || host[0]);
}

TEST(Placement, LaysThirtyNodesOutOnSixtyFourHosts) {
    const auto made = LayoutDice(8).roll(29, 64);
    EXPECT_TRUE(covers(made, place_nodes(made.costs, made.hosts, launcher).holds));
}

TEST(Placement, SaysWhatFitsNowhere) {
    auto made = LayoutDice(4).roll(3, 2);
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
    const auto made = LayoutDice(3).roll(2, 2);
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
    EXPECT_GE(found.least, 0.85);
    EXPECT_GE(found.median, 0.95);
}

#endif

}  // namespace
}  // namespace lightnet::placement_test
