// The coordinator, with places that the test plays.
#include "core/run/master/coordinator.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "core/network/graph/check.hpp"
#include "core/network/light/mapped.hpp"
#include "tests/run/places_by_hand.hpp"

namespace lightnet::coordinator_test {
namespace {

// What one node computes fills the pauses of another that it can't ask; who asks both waits for them.
TEST(Coordinator, PreparesNodesThatDoNotAskEachOtherAtTheSameTime) {
    const Registry kinds = test::with_learner();
    const Graph graph = check(
        {"test.lua",
         Nodes{node("scene", "Scene", {Value{std::string("none.pbrt")}}), node("caustics", "PhotonMap", {}),
               node("global", "PhotonMap", {}, {{"paths", Value{"diffuse"}}}),
               node("both", "Combine", {Value{NodeRef{"caustics"}}, Value{NodeRef{"global"}}}),
               node("learned", "Learner", {Value{NodeRef{"both"}}}),
               node("image", "RayTracer", {Value{NodeRef{"learned"}}},
                    {{"scene", Value{NodeRef{"scene"}}}, {"film", Value{Table{{Value{24.0}, Value{16.0}}, {}}}}})}},
        kinds);
    const std::size_t caustics = 1, global = 2, learned = 4;
    ByHand places;
    Coordinator::Options options;
    options.run = 1;
    options.graph = &graph;
    options.registry = &kinds;
    Coordinator coordinator(options, places);
    const auto lead = [&] { EXPECT_FALSE(coordinator.prepare(std::chrono::milliseconds(2))); };
    const auto next = [&](Step::Kind kind, std::size_t node) {
        auto asked = places.take();
        EXPECT_TRUE(asked.of_kind(kind));
        EXPECT_EQ(asked.message.node, node);
        return asked;
    };
    coordinator.propose({{{"a", 0}}, std::vector<std::vector<std::uint32_t>>(graph.nodes.size(), {0})});
    auto first = next(Step::Kind::prepare, caustics), second = next(Step::Kind::prepare, global);
    EXPECT_TRUE(places.asked.empty());
    EXPECT_EQ(coordinator.progress(), (PrepareProgress{"caustics", 1, 3, 0, 0}));
    // The later one has shards to do while the first still thinks, and is done before it.
    places.answer(std::move(second), StepReport{StepReport::Kind::map, 0, 1});
    lead();
    auto shards = next(Step::Kind::shards, global);
    Message results = reply_to(shards.message);
    const std::vector<std::byte> none;
    results.data = join_shards(std::span(&none, 1));
    places.arrived.push_back(results);
    lead();
    places.answer(next(Step::Kind::go_on, global), StepReport{StepReport::Kind::done, 1, 0});
    lead();
    EXPECT_TRUE(places.asked.empty()) << "not before both are done";
    // Who comes now is led through both, too.
    coordinator.propose({{{"a", 0}, {"b", 0}}, std::vector<std::vector<std::uint32_t>>(graph.nodes.size(), {0, 1})});
    const auto late_first = next(Step::Kind::prepare, caustics), late_second = next(Step::Kind::prepare, global);
    EXPECT_EQ(late_first.place.host, "b");
    places.answer(late_first, StepReport{StepReport::Kind::done, 0, 0});
    places.answer(late_second, StepReport{StepReport::Kind::map, 0, 1});
    lead();
    places.answer(next(Step::Kind::go_on, global), StepReport{StepReport::Kind::done, 1, 0});
    lead();
    EXPECT_EQ(next(Step::Kind::prepare, learned).place.host, "b") << "it has both, and need not wait for a";
    EXPECT_TRUE(places.asked.empty());
    places.answer(std::move(first), StepReport{StepReport::Kind::done, 0, 0});
    lead();
    EXPECT_EQ(next(Step::Kind::prepare, learned).place.host, "a");
    EXPECT_TRUE(places.asked.empty());
}

// A node leaves a host in the middle of its shards, is let go of there, and comes back: it begins anew, and can do no
// shards before it has come to them again.
TEST(Coordinator, AsksNoShardsOfACopyThatHasLetGo) {
    const Registry kinds = test::with_learner();
    const Graph graph = mapping(kinds);
    const auto caustics = graph.find("caustics").value();
    const Plan both{{{"a", 0}, {"b", 0}}, std::vector<std::vector<std::uint32_t>>(graph.nodes.size(), {0, 1})};
    Plan moved = both;
    moved.places_of[caustics] = {0};
    ByHand places;
    Coordinator::Options options;
    options.run = 1;
    options.graph = &graph;
    options.registry = &kinds;
    options.let_go_after = 0.001;
    Coordinator coordinator(options, places);
    const auto lead = [&] { EXPECT_FALSE(coordinator.prepare(std::chrono::milliseconds(2))); };
    // What host b is asked now; shards are answered at once, those of a never.
    const auto asked_of_b = [&] {
        std::vector<Step::Kind> kinds_of_b;
        while (!places.asked.empty()) {
            auto asked = places.take();
            if (asked.place.host != "b") continue;
            kinds_of_b.push_back(asked.step()->kind);
            if (!asked.of_kind(Step::Kind::shards)) continue;
            ShardJoiner joined(asked.step()->count);
            for (std::uint32_t i = 0; i < asked.step()->count; ++i) joined.add({});
            auto reply = reply_to(asked.message);
            reply.data = joined.finish();
            places.arrived.push_back(std::move(reply));
        }
        return kinds_of_b;
    };

    coordinator.propose(both);
    for (int i = 0; i < 2; ++i) places.answer(places.take(), StepReport{StepReport::Kind::map, 0, 100});
    lead();
    EXPECT_THAT(asked_of_b(), testing::Each(Step::Kind::shards));
    coordinator.propose(moved);
    std::vector<Step::Kind> asked;
    for (int patience = 0; patience < 1000 && std::ranges::count(asked, Step::Kind::leave) == 0; ++patience)
        lead(), asked = asked_of_b();
    ASSERT_THAT(asked, testing::Contains(Step::Kind::leave));
    coordinator.propose(both);
    lead();
    EXPECT_THAT(asked_of_b(), testing::ElementsAre(Step::Kind::prepare));
}

// A host leaves after all tiles of a rehearsal are rendered. The rehearsal begins again; what another host still says
// of the first one comes in its middle.
TEST(Coordinator, TakesNoNotesOfARehearsalThatWasBrokenOff) {
    const Registry kinds = test::with_learner();
    const Graph graph = learning(kinds);
    Plan both{{{"a", 0}, {"b", 0}}, std::vector<std::vector<std::uint32_t>>(graph.nodes.size(), {0, 1})};
    const Plan alone{{{"a", 0}}, std::vector<std::vector<std::uint32_t>>(graph.nodes.size(), {0})};
    ByHand places;
    Coordinator::Options options;
    options.run = 1;
    options.graph = &graph;
    options.registry = &kinds;
    Coordinator coordinator(options, places);
    const auto lead = [&] { EXPECT_FALSE(coordinator.prepare(std::chrono::milliseconds(2))); };

    coordinator.propose(both);
    const StepReport rehearses{StepReport::Kind::rehearse, 0, 4};
    for (int i = 0; i < 2; ++i) {
        auto prepare = places.take();
        ASSERT_TRUE(prepare.of_kind(Step::Kind::prepare));
        places.answer(std::move(prepare), rehearses);
    }
    lead();
    auto tiles = places.take();
    ASSERT_TRUE(tiles.of_tiles());
    const auto before = coordinator.progress();
    EXPECT_EQ(before.node, "learned");
    EXPECT_GT(before.total, 0u) << "how far a rehearsal is can be told";
    EXPECT_EQ(before.done, 0u);
    places.answer_tiles(std::move(tiles));
    lead();
    EXPECT_EQ(coordinator.progress().done, before.total);
    auto collect = places.take();
    ASSERT_TRUE(collect.of_kind(Step::Kind::collect));
    ASSERT_EQ(collect.place.host, "a");
    ASSERT_TRUE(places.take().of_kind(Step::Kind::collect));

    coordinator.propose(alone);
    lead();
    tiles = places.take();
    ASSERT_TRUE(tiles.of_tiles()) << "it begins again";
    places.answer(std::move(collect), at(7));
    lead();
    EXPECT_TRUE(places.asked.empty()) << "it is not over";
    places.answer_tiles(std::move(tiles));
    lead();
    collect = places.take();
    ASSERT_TRUE(collect.of_kind(Step::Kind::collect));
    places.answer(std::move(collect), at(9));
    lead();
    const auto go_on = places.take();
    ASSERT_TRUE(go_on.of_kind(Step::Kind::go_on));
    const Mapped<Query> noted(go_on.message.data);
    ASSERT_EQ(noted.size(), 1u);
    EXPECT_EQ(noted.begin()->primitive, 9u);
}

// Two hosts that prepare one node, which has shards to share out.
class ConductorTrouble : public ::testing::Test {
protected:
    ConductorTrouble() {
        Coordinator::Options options;
        options.run = 1;
        options.graph = &graph;
        options.registry = &kinds;
        coordinator.emplace(options, places);
        coordinator->propose(
            {{{"a", 0}, {"b", 0}}, std::vector<std::vector<std::uint32_t>>(graph.nodes.size(), {0, 1})});
    }
    void lead() { EXPECT_FALSE(coordinator->prepare(std::chrono::milliseconds(2))); }

    Registry kinds = test::with_learner();
    Graph graph = mapping(kinds);
    ByHand places;
    std::optional<Coordinator> coordinator;
};

TEST_F(ConductorTrouble, OfOneHostTakesOutThatHost) {
    places.fail(places.take(), "on a place 0: std::bad_alloc");
    lead();
    EXPECT_EQ(places.taken_out, std::vector<std::string>{"a: on a place 0: std::bad_alloc"});
}

TEST_F(ConductorTrouble, OfTwoHostsWithTheSamePartIsTheRunsOwn) {
    auto at_a = places.take(), at_b = places.take();
    places.fail(std::move(at_a), "on a place 0: no photon came anywhere");
    lead();
    places.fail(std::move(at_b), "on b place 0: no photon came anywhere");
    try {
        coordinator->prepare(std::chrono::milliseconds(2));
        FAIL() << "nobody noticed";
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(), "on b place 0: no photon came anywhere");
    }
}

TEST_F(ConductorTrouble, OfAHostThatSaysNonsenseIsThatHosts) {
    places.answer(places.take(), char{7});  // no report
    places.answer(places.take(), StepReport{StepReport::Kind::map, 0, 4});
    lead();
    ASSERT_EQ(places.taken_out.size(), 1u);
    EXPECT_EQ(places.taken_out[0].substr(0, 2), "a:");
    auto shards = places.take();
    ASSERT_TRUE(shards.of_kind(Step::Kind::shards));
    EXPECT_EQ(shards.place.host, "b") << "which goes on alone";
}

// The host that does it dies, and comes back as another process, again and again.
TEST_F(ConductorTrouble, OfAShardThatKillsWhoeverDoesItEndsTheRun) {
    constexpr std::uint32_t shards = 12, poison = 4;
    const std::vector<std::vector<std::uint32_t>> at_a(graph.nodes.size(), {0});
    const auto host_is_back = [&](std::uint64_t process) {
        coordinator->propose({{}, std::vector<std::vector<std::uint32_t>>(graph.nodes.size())});
        places.asked.clear();
        places.arrived.clear();
        coordinator->propose({{{"a", 0}}, at_a, {}, {}, {{"a", process}}});
    };
    std::string ended;
    try {
        for (std::uint64_t process = 2; process < 100; ++process) {
            host_is_back(process);
            for (bool alive = true; alive;) {
                coordinator->prepare(std::chrono::milliseconds(1));
                if (places.asked.empty()) continue;
                auto asked = places.take();
                const Step& step = *asked.step();
                if (step.kind == Step::Kind::prepare) {
                    places.answer(std::move(asked), StepReport{StepReport::Kind::map, 0, shards});
                    continue;
                }
                ASSERT_EQ(step.kind, Step::Kind::shards);
                alive = !(step.first <= poison && poison < step.first + step.count);
                if (!alive) continue;
                Message results = reply_to(asked.message);
                const std::vector<std::vector<std::byte>> nothing(step.count);
                results.data = join_shards(nothing);
                places.arrived.push_back(results);
            }
        }
    } catch (const Error& error) {
        ended = error.what();
    }
    EXPECT_EQ(
        ended,
        "caustics: shard 4 of what a node prepares is set aside: hosts died of it, with nothing else to do: a, a, a");
}

// Those who learn anew are asked again, also one that is still at the pass before, and the others are not.
TEST(Coordinator, GoesOnToTheNextPassWithAllWhoLearnAnew) {
    const Registry kinds = test::with_learner();
    const Graph graph = check(
        {"test.lua",
         Nodes{node("scene", "Scene", {Value{std::string("none.pbrt")}}), node("caustics", "PhotonMap", {}),
               node("maps", "ProgressivePhotonMapping", {}),
               node("both", "Combine", {Value{NodeRef{"caustics"}}, Value{NodeRef{"maps"}}}),
               node("image", "RayTracer", {Value{NodeRef{"both"}}},
                    {{"scene", Value{NodeRef{"scene"}}}, {"film", Value{Table{{Value{24.0}, Value{16.0}}, {}}}}})}},
        kinds);
    const std::size_t maps = 2;
    ByHand places;
    Coordinator::Options options;
    options.run = 1;
    options.graph = &graph;
    options.registry = &kinds;
    Coordinator coordinator(options, places);
    const auto prepared = [&] { return coordinator.prepare(std::chrono::milliseconds(2)); };
    coordinator.propose({{{"a", 0}}, std::vector<std::vector<std::uint32_t>>(graph.nodes.size(), {0})});
    for (int i = 0; i < 2; ++i) places.answer(places.take(), StepReport{StepReport::Kind::done, 0, 0});
    EXPECT_TRUE(prepared());
    coordinator.propose({{{"a", 0}, {"b", 0}}, std::vector<std::vector<std::uint32_t>>(graph.nodes.size(), {0, 1})});
    places.answer(places.take(), StepReport{StepReport::Kind::done, 0, 0});
    const auto late = places.take();  // b prepares `maps` for a pass that is soon over
    EXPECT_EQ(late.message.node, maps);

    coordinator.begin_pass(1);
    auto of_a = places.take(), of_b = places.take();
    EXPECT_TRUE(places.asked.empty());
    for (const auto* asked : {&of_a, &of_b}) {
        ASSERT_TRUE(asked->of_kind(Step::Kind::prepare));
        EXPECT_EQ(asked->message.node, maps);
        EXPECT_EQ(asked->step()->call, first_call_of(1));
    }
    const StepReport done{StepReport::Kind::done, first_call_of(1), 0};
    const auto can_be_asked = [&] {
        while (coordinator.receive()) {
        }
        return coordinator.in_force().places_of[maps];
    };
    places.answer(late, StepReport{StepReport::Kind::done, 0, 0});
    EXPECT_FALSE(prepared()) << "what b says of the pass before does not count";
    places.answer(of_a, done);
    EXPECT_TRUE(prepared());
    EXPECT_EQ(can_be_asked(), (std::vector<std::uint32_t>{0}));
    places.answer(of_b, done);
    EXPECT_EQ(can_be_asked(), (std::vector<std::uint32_t>{0, 1}));
}

// Two epochs for each rehearsal: one of it, and one of what follows it.
TEST(Coordinator, TakesRepliesAfterMoreRehearsalsThanThereAreEpochs) {
    const Registry kinds = test::with_learner();
    const Graph graph = learning(kinds);
    ByHand places;
    Coordinator::Options options;
    options.run = 1;
    options.graph = &graph;
    options.registry = &kinds;
    Coordinator coordinator(options, places);
    const auto lead = [&] { EXPECT_FALSE(coordinator.prepare(std::chrono::microseconds(50))); };
    for (std::uint32_t rehearsal = 0; rehearsal < Epoch::count / 2 + 2; ++rehearsal) {
        // Each host stays for one rehearsal, which is broken off when the next one has taken its place.
        places.asked.clear();
        coordinator.propose(
            {{{std::to_string(rehearsal), 0}}, std::vector<std::vector<std::uint32_t>>(graph.nodes.size(), {0})});
        auto prepare = places.take();
        ASSERT_TRUE(prepare.of_kind(Step::Kind::prepare)) << rehearsal;
        places.answer(std::move(prepare), StepReport{StepReport::Kind::rehearse, 0, 4});
        for (int patience = 0; places.asked.empty() && patience < 1000; ++patience) lead();
        ASSERT_FALSE(places.asked.empty()) << "nobody is asked for the tiles of rehearsal " << rehearsal;
        ASSERT_TRUE(places.asked.front().of_tiles()) << rehearsal;
        if (rehearsal % 64 && rehearsal + 4 < Epoch::count / 2) continue;
        places.answer_all_tiles(lead);
        ASSERT_TRUE(!places.asked.empty() && places.take().of_kind(Step::Kind::collect))
            << "the reply to rehearsal " << rehearsal << " was not taken";
    }
}

TEST(ConductedRehearsal, CollectsTheNotesOfEveryCopyOnceItIsRendered) {
    ByHand places;
    const NodeCopy one{{"one", 0}, 3}, two{{"two", 0}, 3};
    ConductedRehearsal rehearsal(0, {one, two}, {}, places);
    EXPECT_FALSE(rehearsal.wants_notes_of(one)) << "it has not been rendered";
    rehearsal.render(std::chrono::milliseconds(1));  // it has no tiles
    ASSERT_TRUE(rehearsal.rendered());
    EXPECT_TRUE(rehearsal.wants_notes_of(one));
    rehearsal.asked(one);
    EXPECT_FALSE(rehearsal.wants_notes_of(one));
    EXPECT_FALSE(rehearsal.collect(bytes_of(std::vector<Query>{at(2), at(1)})));
    EXPECT_TRUE(rehearsal.collect(bytes_of(std::vector<Query>{at(1)})));
    const Mapped<Query> noted(rehearsal.result());
    EXPECT_EQ(noted.all().size(), 2u) << "each question once";
}

TEST(ConductedRehearsal, AsksNobodyWhenItIsBroken) {
    ByHand places;
    const NodeCopy one{{"one", 0}, 3};
    ConductedRehearsal rehearsal(0, {one}, {}, places);
    rehearsal.render(std::chrono::milliseconds(1));
    rehearsal.break_off();
    EXPECT_TRUE(rehearsal.broken());
    EXPECT_FALSE(rehearsal.wants_notes_of(one));
}

}  // namespace
}  // namespace lightnet::coordinator_test
