// Forecasts against what can be worked out by hand.
#include "core/run/forecast/forecast.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.hpp"

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
