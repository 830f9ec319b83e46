// Moves of operators, as decided while hosts slow down, come back, and measuring errs.
#include "core/run/forecast/mover.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/run/layout_cases.hpp"
#include "tests/run/moving_world.hpp"

namespace lightnet::mover_test {
namespace {

using namespace test;

// Three hosts of two places; the picture is rendered by all of them, and each has room for one of two operators.
LaidOut three_hosts(double op_seconds = 7e-6) {
    RunCosts costs;
    costs.nodes = {{"caustic", op_seconds}, {"soft", op_seconds / 4}, {"image", 0.02}};
    costs.nodes[0].memory = costs.nodes[1].memory = 6e8;
    costs.nodes[0].preparing =
        costs.nodes[1].preparing = {.shards = 20, .shard_seconds = 1, .own_seconds = 0.1, .bytes = 2e8};
    costs.edges = {{2, 0, 2000, 60}, {2, 1, 2000, 60}};
    costs.order = {0, 1, 2};
    costs.image = 2;
    costs.picture = {1920, 1080, 256, 32};
    std::vector<ForecastHost> hosts;
    for (const char* name : {"a", "b", "c"}) hosts.push_back({.name = name, .places = 2, .memory = 1.2e9 / 1.25});
    return {costs, hosts, {}, {{true, false, true}, {false, true, true}, {false, true, true}}};
}

MovingWorld::Pace slow(std::size_t which, double from, double to, double times) {
    return [=](std::size_t host, double now) { return host == which && now >= from && now < to ? 1 / times : 1.0; };
}
const MovingWorld::Pace steady = [](std::size_t, double) { return 1.0; };

TEST(Mover, LeavesAGoodLayoutAsItIs) {
    MovingWorld world(three_hosts(), steady);
    world.run(60);
    EXPECT_TRUE(world.moves().empty()) << world.moves().front().move.who.front();
}

TEST(Mover, GivesWorkToAHostThatHadNone) {
    auto by = three_hosts();
    by.holds[2] = {false, false, false};
    MovingWorld world(by, steady);
    const double before = world.rate();
    world.run(10);
    ASSERT_EQ(world.moves().size(), 1u);
    EXPECT_TRUE(world.mover().by().holds[2][2]) << "the picture is rendered there as well";
    EXPECT_GT(world.rate(), 1.1 * before);
}

TEST(Mover, RelievesAHostThatBecomesSlow) {
    MovingWorld world(three_hosts(), slow(0, 10, 1e9, 4));
    world.run(10);
    const double before = world.rate();
    ASSERT_TRUE(world.moves().empty());
    world.run(60);
    ASSERT_FALSE(world.moves().empty());
    EXPECT_LE(world.moves().front().at, 12.01) << "two seconds after it became slow";
    EXPECT_LE(world.moves().size(), 2u);
    EXPECT_GT(world.rate(), 0.65 * before) << "two hosts and a quarter are left of three";
}

TEST(Mover, MovesAtMostTwiceForTenSecondsOfSlowness) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        MovingWorld world(three_hosts(), slow(0, 10, 20, 4), 0.1, seed);
        const double at_first = world.rate();
        world.run(10);
        EXPECT_TRUE(world.moves().empty()) << seed;
        world.run(90);
        EXPECT_LE(world.moves().size(), 2u) << seed;
        EXPECT_GT(world.rate(), 0.8 * at_first) << seed << ": it is as quick as before";
    }
}

TEST(Mover, RestsWhereMeasuringErrs) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        MovingWorld world(three_hosts(), steady, 0.1, seed), noisy(three_hosts(), steady, 0.4, seed);
        world.run(120);
        EXPECT_TRUE(world.moves().empty()) << seed << ": " << world.moves().front().move.who.front();
        noisy.run(120);
        EXPECT_LE(noisy.moves().size(), 6u) << seed << ": each takes twice as long as the one before";
    }
}

// Every three seconds another host is slow: whoever followed that would never rest.
TEST(Mover, DoesNotRunAfterWhatGoesRound) {
    const auto round = [](std::size_t host, double now) { return host == std::size_t(now / 3) % 3 ? 0.25 : 1.0; };
    MovingWorld world(three_hosts(), round);
    world.run(120);
    EXPECT_LE(world.moves().size(), 7u) << "each takes twice as long as the one before";
}

TEST(Mover, MovesNothingWhereEverythingIsEverywhere) {
    auto by = three_hosts();
    for (auto& host : by.hosts) host.memory = 2e9;
    by.holds.assign(3, {true, true, true});
    MovingWorld world(by, slow(0, 5, 1e9, 16));
    world.run(60);
    EXPECT_TRUE(world.moves().empty());
    EXPECT_FALSE(world.mover().may_move());
}

// Costs were taken for others at first, so that nodes lie apart though there is room.
TEST(Mover, BringsEverythingEverywhereWhereThatIsQuicker) {
    auto by = three_hosts();
    for (auto& host : by.hosts) host.memory = 2e9;
    MovingWorld world(by, steady);
    world.truth = {8, 1, 1};
    EXPECT_TRUE(world.mover().may_move());
    world.run(20);
    ASSERT_EQ(world.moves().size(), 1u);
    for (const auto& held : world.mover().by().holds) EXPECT_EQ(held, std::vector<bool>(3, true));
    EXPECT_FALSE(world.mover().may_move());
}

// The rehearsal took `caustic` for light, and it is what the picture mainly takes.
TEST(Mover, MendsWhatTheRehearsalTookForSomethingElse) {
    MovingWorld world(three_hosts(), steady);
    world.truth = {8, 1, 1};
    const double before = world.rate();
    world.run(20);
    ASSERT_FALSE(world.moves().empty());
    EXPECT_GT(world.rate(), 1.5 * before);
}

TEST(Mover, GivesALostNodeToOthersAtOnce) {
    MovingWorld world(three_hosts(), steady);
    world.run(5);
    world.lose(0);
    world.run(5.9);
    ASSERT_EQ(world.moves().size(), 1u);
    const auto& holds = world.mover().by().holds;
    EXPECT_TRUE(holds[1][0] || holds[2][0]);
    EXPECT_TRUE(holds[1][1] || holds[2][1]);
}

TEST(Mover, DoesNotMoveShortBeforeTheEnd) {
    auto by = three_hosts();
    by.costs.picture = {320, 200, 16, 32};  // two seconds of six places, or so
    by.costs.nodes[0].preparing.own_seconds = by.costs.nodes[1].preparing.own_seconds = 20;
    MovingWorld world(by, slow(0, 0, 1e9, 4));
    world.run(60);
    EXPECT_EQ(world.left(), 0);
    EXPECT_TRUE(world.moves().empty()) << "preparing takes longer than what is left";
}

// A place that comes beside one that goes has room for both, for a moment.
TEST(Mover, KeepsToTheMemoryOfHostsWhileItMoves) {
    for (std::uint64_t seed = 2; seed <= 12; seed += 2) {
        const auto made = LayoutDice(seed).roll(4, 4);
        LaidOut by{made.costs, made.hosts, launcher, place_nodes(made.costs, made.hosts, launcher).holds};
        by.costs.picture = {4096, 4096, 1024, 16};
        MovingWorld world(by, slow(seed % 4, 3, 1e9, 8));
        const auto before = by.holds;
        world.run(6);
        for (std::size_t host = 0; host < by.hosts.size(); ++host) {
            auto both = before[host];
            const auto& now = world.mover().by().holds[host];
            for (std::size_t node = 0; node < both.size(); ++node) both[node] = both[node] || now[node];
            EXPECT_TRUE(has_room(by.costs, made.hosts[host], now)) << seed;
            ForecastHost wide = made.hosts[host];
            wide.memory *= 1.25;
            if (world.moves().size() == 1) {
                EXPECT_TRUE(has_room(by.costs, wide, both)) << seed;
            }
        }
        EXPECT_TRUE(covers(made, world.mover().by().holds)) << seed;
    }
}

TEST(Mover, SaysWhatMoves) {
    MovingWorld world(three_hosts(), slow(0, 0, 1e9, 8));
    world.run(20);
    ASSERT_FALSE(world.moves().empty());
    const auto& move = world.moves().front().move;
    EXPECT_GE(move.gain, 0.2);
    EXPECT_LT(move.cost, move.seconds / 2);
    const auto said = [&](const std::string& text) {
        return std::any_of(move.who.begin(), move.who.end(),
                           [&](const auto& line) { return line.find(text) != std::string::npos; });
    };
    EXPECT_TRUE(said("caustic ")) << move.who.front();
}

TEST(Mover, DecidesForThirtyNodesOnSixtyFourHosts) {
    const auto made = LayoutDice(8).roll(29, 64);
    LaidOut by{made.costs, made.hosts, launcher, place_nodes(made.costs, made.hosts, launcher).holds};
    by.costs.picture = {4096, 4096, 1024, 16};
    MovingWorld world(by, slow(3, 1, 1e9, 8));
    world.run(6);
    EXPECT_TRUE(covers(made, world.mover().by().holds));
}

}  // namespace
}  // namespace lightnet::mover_test
