// Who is slower than others while nodes prepare, with places that the test plays.
#include <gtest/gtest.h>

#include <numeric>
#include <string>

#include "core/network/light/mapped.hpp"
#include "core/run/master/coordinator.hpp"
#include "tests/run/places_by_hand.hpp"

namespace lightnet::slow_places_test {
namespace {

using coordinator_test::at;
using coordinator_test::ByHand;

// Two hosts of one place each hold every node.
class TwoHosts : public ::testing::Test {
protected:
    explicit TwoHosts(Graph (*made)(const Registry&)) : graph(made(kinds)) {
        coordinator.propose(
            {{{"a", 0}, {"b", 0}}, std::vector<std::vector<std::uint32_t>>(graph.nodes.size(), {0, 1})});
    }
    Coordinator::Options options() const {
        Coordinator::Options options;
        options.run = 1;
        options.graph = &graph;
        options.registry = &kinds;
        return options;
    }

    Registry kinds = test::with_learner();
    Graph graph;
    ByHand places;
    Coordinator coordinator{options(), places};
};

// A map, and an image that asks it.
class SlowPlaces : public TwoHosts {
protected:
    SlowPlaces() : TwoHosts(coordinator_test::mapping) {}
};

// A node that rehearses.
class Rehearsals : public TwoHosts {
protected:
    Rehearsals() : TwoHosts(coordinator_test::learning) {}
};

TEST_F(SlowPlaces, HoldUpNobody) {
    const std::size_t caustics = 1;
    auto at_a = places.take(), at_b = places.take();
    places.answer(std::move(at_a), StepReport{StepReport::Kind::done, 0, 0});
    EXPECT_TRUE(coordinator.prepare(std::chrono::milliseconds(2))) << "a can be asked";
    const auto& nodes = coordinator.in_force().places_of;
    EXPECT_EQ(nodes[caustics], std::vector<std::uint32_t>{0});
    EXPECT_EQ(nodes[2], std::vector<std::uint32_t>{0}) << "b has something else to do";
    places.answer(std::move(at_b), StepReport{StepReport::Kind::done, 0, 0});
    EXPECT_TRUE(coordinator.prepare(std::chrono::milliseconds(2)));
    while (coordinator.receive()) {
    }
    EXPECT_EQ(coordinator.in_force(), coordinator.proposed());
}

// Else a thousand places would be told a thousand plans each, while they begin to be asked.
TEST_F(SlowPlaces, AreNotTheSubjectOfAPlanEach) {
    constexpr std::uint32_t crowd = 300;
    Plan plan = coordinator.proposed();
    plan.places.clear();
    for (std::uint32_t place = 0; place < crowd; ++place) plan.places.push_back({"c", place});
    std::vector<std::uint32_t> everywhere(crowd);
    std::iota(everywhere.begin(), everywhere.end(), 0u);
    plan.places_of.assign(graph.nodes.size(), everywhere);
    places.asked.clear();
    coordinator.propose(plan);
    std::size_t plans = 0, done = 0;
    for (; !places.asked.empty(); ++done) {
        places.answer(places.take(), StepReport{StepReport::Kind::done, 0, 0});
        while (const auto message = coordinator.receive()) plans += message->type == Message::Type::plan;
    }
    EXPECT_EQ(done, crowd);
    EXPECT_LT(plans, crowd / 4);
    coordinator.wait({});
    EXPECT_EQ(coordinator.in_force(), plan);
}

// What has one place alone is asked there, however slow that is.
TEST_F(SlowPlaces, KeepWhatOnlyTheyHave) {
    Plan plan = coordinator.proposed();
    plan.places_of[2] = {1};
    coordinator.propose(plan);
    places.answer(places.take(), StepReport{StepReport::Kind::done, 0, 0});
    EXPECT_TRUE(coordinator.prepare(std::chrono::milliseconds(2)));
    EXPECT_EQ(coordinator.in_force().places_of[1], std::vector<std::uint32_t>{0});
    EXPECT_EQ(coordinator.in_force().places_of[2], std::vector<std::uint32_t>{1});
}

// A node that moves is asked where it was, until it is prepared where it goes.
TEST_F(SlowPlaces, AreNotWaitedForByThoseWhoAskWhatMoves) {
    const std::size_t caustics = 1;
    const StepReport done{StepReport::Kind::done, 0, 0};
    const auto lead = [&] {
        EXPECT_TRUE(coordinator.prepare(std::chrono::milliseconds(2)));
        while (coordinator.receive()) {
        }
        return coordinator.in_force().places_of[caustics];
    };
    Plan plan = coordinator.proposed();
    plan.places_of[caustics] = {0};
    coordinator.propose(plan);
    places.answer(places.take(), done);
    const auto at_b = places.take();  // what b was asked before; nobody waits for it
    ASSERT_EQ(lead(), std::vector<std::uint32_t>{0});

    plan.places_of[caustics] = {1};
    coordinator.propose(plan);
    EXPECT_EQ(at_b.place.host, "b");
    EXPECT_EQ(lead(), std::vector<std::uint32_t>{0}) << "b still prepares it";
    EXPECT_EQ(coordinator.in_force().places_of[2], (std::vector<std::uint32_t>{0, 1})) << "and does the rest";
    places.answer(at_b, done);
    EXPECT_EQ(lead(), std::vector<std::uint32_t>{1});
    EXPECT_EQ(coordinator.in_force(), plan);

    plan.places_of[caustics] = {0};
    coordinator.propose(plan);
    EXPECT_EQ(lead(), std::vector<std::uint32_t>{0}) << "a has it still";
}

// Its place lets go of it when it is asked no more, and prepares it anew when it comes back.
TEST(PlacesLeft, LetGoOfWhatTheyHad) {
    const std::size_t caustics = 1;
    const StepReport done{StepReport::Kind::done, 0, 0};
    const Registry kinds = test::with_learner();
    const Graph graph = coordinator_test::mapping(kinds);
    Coordinator::Options options;
    options.run = 1, options.graph = &graph, options.registry = &kinds;
    options.let_go_after = 0;
    ByHand places;
    Coordinator coordinator(std::move(options), places);
    const auto hear = [&] {
        while (coordinator.receive()) {
        }
        coordinator.wait({});
    };
    Plan plan{{{"a", 0}, {"b", 0}}, {{}, {0}, {0, 1}}};
    coordinator.propose(plan);
    places.answer(places.take(), done);
    hear();
    plan.places_of[caustics] = {1};
    coordinator.propose(plan);
    hear();
    auto at_b = places.take();
    EXPECT_TRUE(at_b.of_kind(Step::Kind::prepare));
    EXPECT_TRUE(places.asked.empty()) << "a is still asked";
    places.answer(std::move(at_b), done);
    hear();
    const auto at_a = places.take();
    EXPECT_EQ(at_a.place.host, "a");
    EXPECT_TRUE(at_a.of_kind(Step::Kind::leave));
    hear();
    EXPECT_TRUE(places.asked.empty()) << "once";
    plan.places_of[caustics] = {0};
    coordinator.propose(plan);
    const auto again = places.take();
    EXPECT_EQ(again.place.host, "a");
    EXPECT_TRUE(again.of_kind(Step::Kind::prepare));
}

// A host that leaves is there, and holds nothing any more.
TEST_F(SlowPlaces, AreNotSparedByAHostThatLeaves) {
    const std::size_t caustics = 1;
    Plan plan = coordinator.proposed();
    plan.places_of[caustics] = {0};
    coordinator.propose(plan);
    places.answer(places.take(), StepReport{StepReport::Kind::done, 0, 0});
    EXPECT_TRUE(coordinator.prepare(std::chrono::milliseconds(2)));
    plan.places_of = {{}, {1}, {1}};
    coordinator.propose(plan);
    EXPECT_TRUE(coordinator.in_force().places_of[caustics].empty());
}

// Where it was, it isn't any more.
TEST_F(SlowPlaces, AreWaitedForWhereWhatMovesWasOnALostHost) {
    const std::size_t caustics = 1;
    Plan plan = coordinator.proposed();
    plan.places_of[caustics] = {0};
    coordinator.propose(plan);
    places.answer(places.take(), StepReport{StepReport::Kind::done, 0, 0});
    EXPECT_TRUE(coordinator.prepare(std::chrono::milliseconds(2)));
    coordinator.propose({{{"b", 0}}, {{}, {0}, {0}}});
    EXPECT_TRUE(coordinator.in_force().places_of[caustics].empty());
}

// A rehearsal waits for a while for who is slower, and then goes on without him.
TEST_F(Rehearsals, BeginWithoutASlowHost) {
    auto at_a = places.take(), at_b = places.take();
    const StepReport rehearses{StepReport::Kind::rehearse, 0, 4};
    places.answer(std::move(at_a), rehearses);
    EXPECT_FALSE(coordinator.prepare(std::chrono::milliseconds(20)));
    EXPECT_TRUE(places.asked.empty()) << "b may come";
    EXPECT_FALSE(coordinator.prepare(std::chrono::milliseconds(800)));
    ASSERT_FALSE(places.asked.empty());
    EXPECT_TRUE(places.asked.front().of_tiles());
    for (const auto& asked : places.asked) EXPECT_EQ(asked.place.host, "a");
    places.answer_all_tiles([&] { EXPECT_FALSE(coordinator.prepare(std::chrono::milliseconds(2))); });
    auto collect = places.take();
    ASSERT_TRUE(collect.of_kind(Step::Kind::collect));
    EXPECT_TRUE(places.asked.empty()) << "b has noted nothing";
    places.answer(std::move(collect), at(9));
    places.answer(std::move(at_b), rehearses);
    EXPECT_FALSE(coordinator.prepare(std::chrono::milliseconds(2)));
    for (const char* host : {"a", "b"}) {
        const auto go_on = places.take();
        ASSERT_TRUE(go_on.of_kind(Step::Kind::go_on));
        EXPECT_EQ(go_on.place.host, host);
        const Mapped<Query> noted(go_on.message.data);
        ASSERT_EQ(noted.size(), 1u);
        EXPECT_EQ(noted.begin()->primitive, 9u);
    }
}

// Somebody may not have heard yet that the rehearsal is over, and would ask b, who would answer as in a rehearsal.
TEST_F(Rehearsals, AreOverWhenAllWhoTookPartArePrepared) {
    const auto lead = [&](int milliseconds) { return coordinator.prepare(std::chrono::milliseconds(milliseconds)); };
    for (int i = 0; i < 2; ++i) places.answer(places.take(), StepReport{StepReport::Kind::rehearse, 0, 4});
    EXPECT_FALSE(lead(2));
    places.answer_all_tiles([&] { EXPECT_FALSE(lead(1)); });
    for (int i = 0; i < 2; ++i) places.answer(places.take(), at(9));
    EXPECT_FALSE(lead(2));
    const auto a_goes_on = places.take(), b_goes_on = places.take();
    ASSERT_TRUE(b_goes_on.of_kind(Step::Kind::go_on));
    places.answer(a_goes_on, StepReport{StepReport::Kind::done, 1, 0});
    EXPECT_FALSE(lead(600));
    places.answer(b_goes_on, StepReport{StepReport::Kind::done, 1, 0});
    EXPECT_TRUE(lead(2));
}

}  // namespace
}  // namespace lightnet::slow_places_test
