// Thousands of invented runs: whatever workers and network do, every tile comes once, and the run ends.
#include "tests/run/simulator.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>

#include "tests/support/slowdown.hpp"

namespace lightnet::test::simulator_test {
namespace {

// Of each kind of world.
#ifdef LIGHTNET_LARGE
constexpr std::uint64_t seeds = 10000;
#else
constexpr std::uint64_t seeds = 500 / slowdown;
#endif

// `LIGHTNET_SEED` in the environment plays one seed again.
void for_every_seed(const std::function<void(std::uint64_t)>& play_seed) {
    if (const char* only = std::getenv("LIGHTNET_SEED")) return play_seed(std::stoull(only));
    for (std::uint64_t seed = 1; seed <= seeds && !::testing::Test::HasFailure(); ++seed) play_seed(seed);
}

Told expect_sound(const World& world) {
    SCOPED_TRACE("play it again with LIGHTNET_SEED=" + std::to_string(world.seed));
    Told told;
    try {
        told = play(world);
    } catch (const std::exception& error) {
        ADD_FAILURE() << error.what();
        return told;
    }
    EXPECT_EQ(told.folded.size() + told.set_aside.size(), world.tiles) << "tiles are missing";
    for (const auto& [tile, blocks] : told.folded) EXPECT_EQ(blocks, world.blocks) << "tile " << tile;
    EXPECT_EQ(told.outstanding, 0u) << "credit that did not come back";
    double sum = 0;
    for (const auto& [tile, blocks] : told.folded) sum += tile;
    EXPECT_EQ(told.sum, sum) << "a tile has the pixels of another";
    const bool poisoned = !world.poisonous.empty() || world.deaths > 0;
    EXPECT_TRUE(poisoned || told.set_aside.empty());
    return told;
}

std::size_t times(const Told& told, const std::string& event) {
    std::size_t count = 0;
    for (auto at = told.story.find(event); at != std::string::npos; at = told.story.find(event, at + 1)) ++count;
    return count;
}

// A tile is set aside when it seems to kill hosts. That is unfair where they die by themselves, but never without three
// deaths of which nothing else can be blamed.
void expect_fair(const World& world, const Told& told) {
    for (std::uint32_t tile = 0; tile < world.tiles; ++tile) {
        if (told.folded.contains(tile)) continue;
        const auto deaths = told.died_alone.find(tile);
        EXPECT_TRUE(deaths != told.died_alone.end() && deaths->second >= 3) << "tile " << tile;
    }
}

TEST(SimulatedRun, IsTheSameToTheLastByteForTheSameSeed) {
    for_every_seed([](std::uint64_t seed) {
        World world{.seed = seed, .loss = 0.02, .twice = 0.1, .deaths = 0.01, .drains = 0.01, .hangs = 0.01};
        world.tiles = 30;
        EXPECT_EQ(play(world).story, play(world).story) << "seed " << seed;
    });
}

TEST(SimulatedRun, EndsThoughMessagesAreLostDelayedDoubledAndReordered) {
    for_every_seed([](std::uint64_t seed) { expect_sound({.seed = seed, .delay = 2, .loss = 0.1, .twice = 0.5}); });
}

TEST(SimulatedRun, EndsThoughHostsDieAndComeBack) {
    std::size_t deaths = 0, returns = 0, rendered = 0;
    for_every_seed([&](std::uint64_t seed) {
        const World world{.seed = seed, .twice = 0.1, .deaths = 0.03};
        const auto told = expect_sound(world);
        SCOPED_TRACE("play it again with LIGHTNET_SEED=" + std::to_string(seed));
        for (const auto& text : told.set_aside) EXPECT_NE(text.find("tile 1x1"), std::string::npos);
        expect_fair(world, told);
        deaths += times(told, " dies ");
        returns += times(told, " comes ");
        rendered += told.folded.size();
        EXPECT_GE(told.asks, world.tiles) << "what the dead had was not asked again";
    });
    EXPECT_GT(deaths, 0u);
    EXPECT_GT(returns, 0u);
    EXPECT_GT(rendered, 0u);
}

TEST(SimulatedRun, EndsThoughHostsStandInForEachOtherAgainAndAgain) {
    for_every_seed([](std::uint64_t seed) {
        World world{.seed = seed, .hosts = 2, .places_per_host = 1, .deaths = 0.3};
        world.stand_ins = true;
        world.calm_after = 20;
        expect_sound(world);
    });
}

TEST(SimulatedRun, BlamesNoTileForLinesThatAreCutAgainAndAgain) {
    for_every_seed([](std::uint64_t seed) {
        World world{.seed = seed, .hosts = 2, .places_per_host = 1, .cuts = 0.4};
        world.calm_after = 200;
        EXPECT_EQ(expect_sound(world).counters.set_aside, 0u);
    });
}

TEST(SimulatedRun, LosesNothingToHostsThatLeaveInGoodOrder) {
    for_every_seed([](std::uint64_t seed) {
        const auto told = expect_sound({.seed = seed, .drains = 0.03});
        EXPECT_EQ(told.counters.set_aside, 0u);
    });
}

TEST(SimulatedRun, DoesTheWorkOfHangingHostsElsewhereAndKillsNobody) {
    for_every_seed([](std::uint64_t seed) { expect_sound({.seed = seed, .hangs = 0.02}); });
}

TEST(SimulatedRun, EndsOnTheLastPlaceThatIsLeft) {
    for_every_seed([](std::uint64_t seed) {
        World world{.seed = seed, .hosts = 1, .places_per_host = 1, .loss = 0.05, .twice = 0.2, .deaths = 0.005};
        world.tiles = 20;
        expect_sound(world);
    });
}

TEST(SimulatedRun, EndsWithAllOfThisAtOnceWhateverTheStrategy) {
    for_every_seed([](std::uint64_t seed) {
        World world{
            .seed = seed, .delay = 0.5, .loss = 0.02, .twice = 0.1, .deaths = 0.01, .drains = 0.01, .hangs = 0.01};
        world.strategy = static_cast<Strategy>(seed % strategy_names.size());
        world.credit = {1 + seed % 4, (1 + seed % 4) * (1 + seed % 3)};
        if (seed % 2) world.seconds_per_tile = 0.01;
        expect_sound(world);
    });
}

TEST(SimulatedRun, SetsAsideTilesThatKillHostsAndNoOthers) {
    for_every_seed([](std::uint64_t seed) {
        World world{.seed = seed};
        world.poisonous = {7, 31};
        const auto told = expect_sound(world);
        SCOPED_TRACE("play it again with LIGHTNET_SEED=" + std::to_string(seed));
        EXPECT_FALSE(told.folded.contains(7));
        EXPECT_FALSE(told.folded.contains(31));
        ASSERT_EQ(told.set_aside.size(), 2u);
        for (const auto tile : world.poisonous) EXPECT_GE(told.died_alone.at(tile), 3);
    });
}

TEST(SimulatedRun, KnowsHostsAndLetsEachDealToItsPlaces) {
    for_every_seed([](std::uint64_t seed) {
        World world{.seed = seed, .places_per_host = 4, .loss = 0.02, .twice = 0.1, .deaths = 0.01, .hangs = 0.01};
        world.strategy = static_cast<Strategy>(seed % strategy_names.size());
        const auto told = expect_sound(world);
        EXPECT_EQ(told.asked_of_hosts, told.asks) << "no place by its number";
        EXPECT_GE(told.dealt + told.asks / 2, told.asks) << "but what was lost with hosts";
        world.places_per_host = 1;
        EXPECT_EQ(expect_sound(world).asked_of_hosts, 0u) << "nothing to choose";
    });
}

// Ideal: as many places as there are, each at work all the time.
TEST(SimulatedRun, KeepsAllPlacesOfHostsAtWork) {
    double ideal = 0, took = 0;
    for_every_seed([&](std::uint64_t seed) {
        const World world{.seed = seed, .hosts = 3, .places_per_host = 8, .tiles = 600, .seconds_per_tile = 0.1};
        const auto told = expect_sound(world);
        ideal += double(world.tiles) / told.tiles_per_second;
        took += told.finished;
    });
    EXPECT_GT(ideal / took, 0.85);
}

TEST(SimulatedRun, HandsOutQuickTilesTogether) {
    for_every_seed([](std::uint64_t seed) {
        World world{.seed = seed, .tiles = 1500, .seconds_per_tile = 0.001};
        const auto singly = expect_sound(world);
        EXPECT_GE(singly.asks, world.tiles);
        world.credit = {3, 24};
        EXPECT_LT(expect_sound(world).asks, singly.asks / 2);
    });
}

TEST(SimulatedRun, HandsOutGroupsAsAWholeUntilTheEndIsNear) {
    for_every_seed([](std::uint64_t seed) {
        World world{.seed = seed, .tiles = 300, .blocks = 8, .seconds_per_tile = 0.005};
        world.credit = {3, 24};
        EXPECT_LT(expect_sound(world).asks, 2 * world.tiles);
        world.tiles = 40;
        world.seconds_per_tile = 2;  // there is no time for eight of them
        EXPECT_GE(expect_sound(world).asks, 8 * world.tiles);
    });
}

TEST(SimulatedRun, LosesNoBlockOfGroupsWhateverHappens) {
    for_every_seed([](std::uint64_t seed) {
        World world{
            .seed = seed, .delay = 0.5, .loss = 0.02, .twice = 0.1, .cuts = 0.02, .drains = 0.01, .hangs = 0.01};
        world.tiles = 40 + seed % 40, world.blocks = 1 + seed % 8;
        world.seconds_per_tile = seed % 3 ? 0.02 : 0.5;
        world.credit = {2, 16};
        expect_sound(world);
    });
}

TEST(SimulatedRun, FindsTheTileThatKillsAmongThoseThatWentTogether) {
    for_every_seed([](std::uint64_t seed) {
        World world{.seed = seed, .tiles = 200, .seconds_per_tile = 0.005, .loss = 0.01, .twice = 0.1};
        world.credit = {2, 16};
        world.poisonous = {47, 131};
        const auto told = expect_sound(world);
        SCOPED_TRACE("play it again with LIGHTNET_SEED=" + std::to_string(seed));
        EXPECT_EQ(told.set_aside.size(), 2u);
        for (const auto tile : world.poisonous) EXPECT_FALSE(told.folded.contains(tile));
    });
}

TEST(SimulatedRun, ConvictsOnlyAfterThreeDeathsAlone) {
    for_every_seed([](std::uint64_t seed) {
        World world{.seed = seed, .deaths = 0.05};
        world.poisonous = {5};
        const auto told = expect_sound(world);
        SCOPED_TRACE("play it again with LIGHTNET_SEED=" + std::to_string(seed));
        expect_fair(world, told);
        EXPECT_FALSE(told.folded.contains(5)) << "it kills whoever renders it";
    });
}

}  // namespace
}  // namespace lightnet::test::simulator_test
