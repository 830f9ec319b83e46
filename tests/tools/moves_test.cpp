// Layouts that change in mid-run, as plans.
#include "tools/session/moves.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/parse.hpp"

namespace lightnet::moves_test {
namespace {

using namespace test;

// Two hosts, "a" and "b", of two places each. `b` has no node at first.
class TwoHostsThatShare : public ::testing::Test {
protected:
    TwoHostsThatShare() {
        by.costs.nodes.resize(graph.nodes.size());
        by.costs.image = renderer_of(graph, kinds);
        const auto light = *graph.find("lighting");
        for (std::size_t node = 0; node < graph.nodes.size(); ++node)
            by.costs.nodes[node].name = graph.nodes[node].name;
        by.costs.nodes[light].seconds = 1e-5, by.costs.nodes[light].memory = 1e9;
        by.costs.nodes[by.costs.image].seconds = 0.01;
        by.costs.edges = {{by.costs.image, light, 1000, 60}};
        by.costs.order = {light, by.costs.image};
        by.costs.picture = {320, 320, 256, 32};
        by.hosts = {{.name = "a", .places = 2, .memory = 1.5e9}, {.name = "b", .places = 2, .memory = 0.5e9}};
        by.holds.assign(2, std::vector<bool>(graph.nodes.size()));
        by.holds[0][light] = by.holds[0][by.costs.image] = true;
        hosts.hosts = {{"a", {}, 2, {}}, {"b", {}, 2, {}}};
    }

    Registry kinds = fake_registry();
    Graph graph = sound_graph("lighting = Ambient {}");
    LaidOut by;
    Hosts hosts;
};

TEST_F(TwoHostsThatShare, HaveAllTheirPlacesInAPlan) {
    const Moves moves(by, {graph, kinds, hosts});
    const auto plan = moves.plan({{"a", 2}, {"b", 2}});
    EXPECT_EQ(plan.places.size(), 4u);
    for (const auto node : by.costs.order)
        for (const auto place : plan.places_of[node]) EXPECT_EQ(plan.places[place].host, "a");
    EXPECT_TRUE(fits(plan, graph));
}

TEST_F(TwoHostsThatShare, TakeWhatAHostHadThatIsGone) {
    const Moves moves(by, {graph, kinds, hosts});
    const auto plan = moves.plan({{"b", 2}});
    EXPECT_EQ(plan.places.size(), 2u);
    for (const auto node : by.costs.order) EXPECT_FALSE(plan.places_of[node].empty());
}

// `a` becomes slow, and only the picture has room at `b`.
TEST_F(TwoHostsThatShare, MoveWhatHasRoom) {
    Moves moves(by, {graph, kinds, hosts});
    std::vector<HostState> states(2);
    states[0].name = "a", states[1].name = "b";
    const auto edges = asking_edges(graph, layers_of(graph, kinds), kinds);
    std::optional<Move> moved;
    for (int second = 1; second < 20 && !moved; ++second) {
        for (auto& state : states) {
            const std::uint64_t busy = state.name == "a" ? 100 * second : 0,
                                idle = state.name == "a" ? 0 : 100 * second;
            state.there = true, state.places = 2;
            state.figures.places = {{busy, 0, 0, idle}, {busy, 0, 0, idle}};
            state.figures.nodes.assign(graph.nodes.size(), {});
            state.figures.nodes[by.costs.image].looks = busy, state.figures.nodes[by.costs.order[0]].looks = busy;
            state.figures.edges.assign(edges.size(), {});
            state.figures.clock_ns = std::uint64_t(second) * 1'000'000'000;
            state.figures.processor_ns = state.name == "a" ? std::uint64_t(second) * 500'000'000 : 0;
        }
        moved = moves.look(
            second, [&] { return states; }, 0.005 * second, 1e9);
    }
    ASSERT_TRUE(moved);
    EXPECT_TRUE(moves.take_change());
    EXPECT_FALSE(moves.take_change()) << "once";
    const auto plan = moves.plan({{"a", 2}, {"b", 2}});
    const auto at_b = [&](std::size_t node) {
        const auto& places = plan.places_of[node];
        return std::any_of(places.begin(), places.end(), [&](auto place) { return plan.places[place].host == "b"; });
    };
    EXPECT_TRUE(at_b(by.costs.image));
    EXPECT_FALSE(at_b(by.costs.order[0]));
    EXPECT_NE(moved->who.front().find("image "), std::string::npos) << moved->who.front();
}

}  // namespace
}  // namespace lightnet::moves_test
