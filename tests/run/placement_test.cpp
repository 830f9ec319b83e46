// Layouts against all others that there are, in random cases where hosts lack memory.
#include "core/run/forecast/placement.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "core/base/error.hpp"
#include "tests/run/all_layouts.hpp"

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
        parts.push_back(AllLayouts(made).best().seconds / seconds_of(made, ours.holds));
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

// The best of all layouts is found without playing all of them.
TEST(AllLayouts, SkipNoneThatIsQuicker) {
    for (const std::uint64_t seed : {4, 7, 9}) {
        const auto made = LayoutDice(seed).roll(2, 2);
        const AllLayouts all(made);
        double least = std::numeric_limits<double>::infinity();
        std::size_t played = 0;
        for (std::uint32_t layout = 0; layout < 64; ++layout) {
            HeldByHosts holds(2, std::vector<bool>(3));
            for (std::uint32_t bit = 0; bit < 6; ++bit) holds[bit / 3][bit % 3] = layout >> bit & 1;
            if (!covers(made, holds) || !has_room(made.costs, made.hosts[0], holds[0]) ||
                !has_room(made.costs, made.hosts[1], holds[1]))
                continue;
            const double seconds = seconds_of(made, holds);
            EXPECT_LE(all.least_seconds({layout & 7, layout >> 3}), seconds) << seed << ", layout " << layout;
            least = std::min(least, seconds), ++played;
        }
        EXPECT_EQ(played, all.size());
        const auto best = all.best();
        EXPECT_EQ(best.seconds, least) << seed;
        EXPECT_LT(best.played, all.size());
        EXPECT_EQ(seconds_of(made, best.holds), least);
    }
}

TEST(Placement, ChangesTwoHostsAtOnceWhereEachHasRoomForOneNode) {
    for (const std::uint64_t seed : {40, 86, 128}) {
        const auto made = LayoutDice(seed).roll(3, 2);
        const double ours = seconds_of(made, place_nodes(made.costs, made.hosts, launcher).holds);
        EXPECT_GT(AllLayouts(made).best().seconds, 0.95 * ours) << seed;
    }
}

TEST(Placement, PutsEverythingEverywhereUnlessThatIsClearlySlower) {
    for (const std::uint64_t seed : {5, 11}) {
        const auto made = LayoutDice(seed).roll(2, 3);
        const auto layout = place_nodes(made.costs, made.hosts, launcher);
        const HeldByHosts everywhere(3, std::vector<bool>(3, true));
        if (layout.holds == everywhere) continue;
        EXPECT_LT(seconds_of(made, layout.holds), 0.95 * seconds_of(made, everywhere)) << seed;
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

// Else it would not be called, and no node could ever move to it.
TEST(Placement, KeepsHostsThatHoldNothingInTheRun) {
    const auto made = LayoutDice(3).roll(2, 3);
    HeldByHosts holds(3, std::vector<bool>(3, true));
    holds[1] = {false, false, false};
    Hosts known;
    for (const auto& host : made.hosts) known.hosts.push_back({host.name, {}, 0, {}});
    const auto said = hosts_of(holds, made.costs, made.hosts, known);
    ASSERT_EQ(said.hosts.size(), 2u) << "a hosts file names those that hold something";
    known.hosts.push_back({"here", {}, 1, {}});
    const auto all = with_empty_hosts(said, made.costs, known);
    ASSERT_EQ(all.hosts.size(), 3u) << "this process needs no host to be called";
    EXPECT_EQ(all.hosts[0], said.hosts[0]);
    EXPECT_EQ(all.hosts[1].endpoint, "host1");
    EXPECT_EQ(all.hosts[1].replicas, (std::map<std::string, int>{{"image", 0}}));
    EXPECT_EQ(all.hosts[2], said.hosts[1]);
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
