// Forecasts against what can be worked out by hand.
#include "core/run/forecast/forecast.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.hpp"
#include "core/run/forecast/shared_processors.hpp"

namespace lightnet::forecast_test {
namespace {

constexpr LineCost quick{1e12, 0};

// A renderer of so many usual tiles, which take `seconds` each, and one node that it asks.
RunCosts costs_of(std::uint32_t tiles, double seconds, double questions = 0, double each = 0) {
    RunCosts costs;
    costs.nodes = {{"light", each}, {"image", seconds}};
    if (questions > 0) costs.edges = {{1, 0, questions, 60}};
    costs.order = {0, 1};
    costs.image = 1;
    std::uint32_t rows = 1;
    while (4 * rows * rows <= tiles && tiles % (2 * rows) == 0) rows *= 2;
    costs.picture = {tiles / rows * 16, rows * 16, 16, 16};
    return costs;
}

std::vector<ForecastHost> hosts_of(std::uint32_t count, std::uint32_t places = 1) {
    std::vector<ForecastHost> hosts;
    for (std::uint32_t i = 0; i < count; ++i)
        hosts.push_back({.name = "host" + std::to_string(i), .places = places, .line = quick});
    return hosts;
}

// Each place of the first hosts holds one of these sets of nodes, by turns.
Plan plan_of(const RunCosts& costs, const std::vector<ForecastHost>& hosts,
             const std::vector<std::vector<std::size_t>>& sets) {
    Plan plan;
    plan.places_of.resize(costs.nodes.size());
    for (std::size_t host = 0; host < hosts.size(); ++host)
        for (std::uint32_t place = 0; place < hosts[host].places; ++place) {
            for (const auto node : sets[host % sets.size()])
                plan.places_of[node].push_back(static_cast<std::uint32_t>(plan.places.size()));
            plan.places.push_back({hosts[host].name, place});
        }
    return plan;
}

Forecast everywhere(const RunCosts& costs, const std::vector<ForecastHost>& hosts, const LineCost& launcher = quick) {
    return forecast(costs, plan_of(costs, hosts, {{0, 1}}), hosts, launcher, 1);
}

TEST(Forecast, DealsEqualTilesEquallyToEqualPlaces) {
    const auto costs = costs_of(96, 0.5);
    for (const std::uint32_t hosts : {1u, 2u, 4u, 8u}) {
        const auto found = everywhere(costs, hosts_of(hosts, 3));
        const double ideal = 96 * 0.5 / (3 * hosts);
        EXPECT_GE(found.seconds, ideal) << hosts;
        EXPECT_LE(found.seconds, ideal + 0.5) << hosts;
        EXPECT_NEAR(found.efficiency, ideal / found.seconds, 1e-3) << hosts;
        EXPECT_EQ(found.parts.front().what, BusyPart::What::places) << hosts;
    }
}

TEST(Forecast, CountsWhatIsCalledAtTheSamePlace) {
    const auto found = everywhere(costs_of(40, 0.25, 500, 0.0005), hosts_of(4));
    EXPECT_NEAR(found.seconds, 40 * (0.25 + 500 * 0.0005) / 4, 0.02 * found.seconds);
    EXPECT_NEAR(found.by_node[0], 40 * 500 * 0.0005, 1e-9);
}

TEST(Forecast, GivesQuickHostsMore) {
    auto hosts = hosts_of(2);
    hosts[0].speed = 3;
    const auto found = everywhere(costs_of(400, 0.5), hosts);
    EXPECT_NEAR(found.seconds, 400 * 0.5 / 4, 0.03 * found.seconds);
}

// Four places with one processor: as one place, where all have work; and one that works alone has all of it.
TEST(Forecast, SharesProcessorsAmongPlacesThatWork) {
    auto hosts = hosts_of(1, 4);
    hosts[0].processors = 1;
    auto costs = costs_of(400, 0.05);
    auto found = everywhere(costs, hosts);
    EXPECT_NEAR(found.render, 20, 0.2);
    EXPECT_NEAR(found.efficiency, 1, 0.01);
    costs.nodes[0].preparing = {.shards = 400, .shard_seconds = 40, .own_seconds = 3, .bytes = 0};
    found = everywhere(costs, hosts);
    EXPECT_NEAR(found.prepare, 43, 0.5);
    const auto alone = forecast(costs_of(400, 0.05), plan_of(costs, hosts_of(1, 1), {{0, 1}}), hosts, quick, 1);
    EXPECT_NEAR(alone.render, 20, 0.2) << "one of its places alone";
}

TEST(Forecast, GivesPlacesPartsOfAProcessor) {
    auto hosts = hosts_of(2);
    hosts[0].processors = 0.25;
    EXPECT_NEAR(everywhere(costs_of(400, 0.05), hosts).render, 20 / 1.25, 0.5);
}

TEST(SharedProcessors, GiveEachAnEqualShareOfWhatThereIs) {
    EventQueue events;
    SharedProcessors processors(events, 1.5);
    std::vector<double> ends;
    const auto note = [&] { ends.push_back(events.now()); };
    processors.work(1, note);                              // alone until .5, then with others
    events.at(0.5, [&] { processors.work(1, note); });     // two: .75 each
    events.at(0.5, [&] { processors.work(0.25, note); });  // three: .5 each
    while (events.next() < EventQueue::never) events.step();
    ASSERT_EQ(ends.size(), 3u);
    EXPECT_NEAR(ends[0], 1, 1e-9) << "the third has had a quarter by then";
    EXPECT_NEAR(ends[1], 1 + 0.25 / 0.75, 1e-9) << "the first had .75";
    EXPECT_NEAR(ends[2], 1 + 0.25 / 0.75 + 0.5, 1e-9) << "alone at the end";
    processors.work(2, note);
    while (events.next() < EventQueue::never) events.step();
    EXPECT_NEAR(ends[3], ends[2] + 2, 1e-9);
}

TEST(Forecast, FollowsAmdahl) {
    auto costs = costs_of(256, 0.5);
    costs.nodes[1].preparing = {.shards = 0, .shard_seconds = 0, .own_seconds = 20, .bytes = 0};
    for (const std::uint32_t hosts : {1u, 4u, 16u}) {
        const auto found = everywhere(costs, hosts_of(hosts));
        EXPECT_NEAR(found.seconds, 20 + 128.0 / hosts, 0.02 * found.seconds) << hosts;
    }
    const auto found = everywhere(costs, hosts_of(16));
    EXPECT_EQ(found.parts.front(), (BusyPart{BusyPart::What::preparing, "image", found.parts.front().share}));
}

TEST(Forecast, SharesThePiecesOfPreparing) {
    auto costs = costs_of(16, 0.5);
    costs.nodes[0].preparing = {.shards = 400, .shard_seconds = 40, .own_seconds = 0, .bytes = 0};
    const auto found = everywhere(costs, hosts_of(8));
    EXPECT_NEAR(found.prepare, 5, 0.2);
}

// Of eight places seven wait while one does the last piece of a round.
TEST(Forecast, WaitsForTheEndOfEachRoundOfPreparing) {
    auto costs = costs_of(16, 0.5);
    costs.nodes[0].preparing = {.shards = 36, .shard_seconds = 36, .own_seconds = 0, .bytes = 0, .rounds = 4};
    EXPECT_NEAR(everywhere(costs, hosts_of(8)).prepare, 4 * 2, 0.1);
    costs.nodes[0].preparing.rounds = 1;
    EXPECT_NEAR(everywhere(costs, hosts_of(8)).prepare, 5, 0.1);
}

// Half a second, and those who are later still take no part at first.
TEST(Forecast, WaitsForThoseWhoAreLateForARehearsal) {
    auto costs = costs_of(16, 0.5);
    costs.nodes[0].preparing = {.shards = 0, .shard_seconds = 0, .own_seconds = 0.2, .bytes = 0};
    costs.nodes[1].preparing = {.shards = 80, .shard_seconds = 8, .own_seconds = 0, .bytes = 0, .rehearses = true};
    auto hosts = hosts_of(2);
    hosts[1].speed = 0.5;
    EXPECT_NEAR(everywhere(costs, hosts).prepare, 0.4 + 8 / 1.5, 0.2);
    hosts[1].speed = 0.1;
    EXPECT_NEAR(everywhere(costs, hosts).prepare, 2 + (8 - (2 - 0.7)) / 1.1, 0.2) << "the late one comes after 2 s";
}

TEST(Forecast, FindsTheSlowLine) {
    const auto costs = costs_of(64, 0.01, 20000, 1e-7);
    auto hosts = hosts_of(2);
    hosts[1].line = {1e6, 1e-3};  // 60 bytes a question, three quarters of them on the way there
    const auto found = forecast(costs, plan_of(costs, hosts, {{1}, {0}}), hosts, quick, 1);
    EXPECT_NEAR(found.seconds, 64 * 20000 * 45 / 1e6, 0.05 * found.seconds);
    EXPECT_EQ(found.parts.front().what, BusyPart::What::line);
    EXPECT_EQ(found.parts.front().name, "host1");
}

TEST(Forecast, FindsTheLaunchersLine) {
    const auto found = everywhere(costs_of(512, 0.01), hosts_of(64), {1e5, 0});
    const double ideal = 512 * 16 * 16 * 12 / 1e5;
    EXPECT_GE(found.seconds, ideal);
    EXPECT_LE(found.seconds, 1.25 * ideal);  // idle hosts do late tiles once more, which comes over it as well
    EXPECT_EQ(found.parts.front().what, BusyPart::What::launcher_line);
}

TEST(Forecast, FindsTheLaunchersThread) {
    auto costs = costs_of(512, 0.01);
    costs.launcher_tile_seconds = 0.02;
    const auto found = everywhere(costs, hosts_of(64));
    EXPECT_NEAR(found.seconds, 512 * 0.02, 0.05 * found.seconds);
    EXPECT_EQ(found.parts.front().what, BusyPart::What::launcher_thread);
}

TEST(Forecast, FindsTheNodeThatHasTooFewPlaces) {
    const auto costs = costs_of(200, 0.001, 1000, 1e-4);
    const auto hosts = hosts_of(4);
    const auto found = forecast(costs, plan_of(costs, hosts, {{1}, {0}, {1}, {1}}), hosts, quick, 1);
    EXPECT_NEAR(found.seconds, 200 * 1000 * 1e-4, 0.05 * found.seconds);
    EXPECT_EQ(found.parts.front(), (BusyPart{BusyPart::What::node, "light", found.parts.front().share}));
}

// A place that holds all is relieved by one that holds a part.
TEST(Forecast, KnowsRelief) {
    const auto costs = costs_of(200, 0.01, 1000, 4e-5);
    const auto hosts = hosts_of(2);
    const auto found = forecast(costs, plan_of(costs, hosts, {{0, 1}, {0}}), hosts, quick, 1);
    const double alone = 200 * 0.05;
    EXPECT_GE(found.seconds, alone / 2);
    EXPECT_LE(found.seconds, 0.65 * alone);
}

TEST(Forecast, IsTheSameEachTime) {
    auto costs = costs_of(300, 0.02, 100, 1e-4);
    costs.spread = {{0.5, 3}, {1, 2}, {3, 1}};
    const auto first = everywhere(costs, hosts_of(5, 2)), second = everywhere(costs, hosts_of(5, 2));
    EXPECT_EQ(first.seconds, second.seconds);
    EXPECT_EQ(first.parts, second.parts);
}

TEST(Forecast, ServesTwoThousandHosts) {
    const auto found = everywhere(costs_of(16000, 0.5), hosts_of(2000));
    EXPECT_GT(found.efficiency, 0.8);
    EXPECT_GE(found.seconds, 4);
}

TEST(Forecast, NamesAHostOfWhichNothingIsKnown) {
    const auto costs = costs_of(4, 0.1);
    EXPECT_THROW(forecast(costs, plan_of(costs, hosts_of(2), {{0, 1}}), hosts_of(1), quick, 1), Error);
}

}  // namespace
}  // namespace lightnet::forecast_test
