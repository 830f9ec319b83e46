// The conductor, with places that the test plays.
#include "core/run/runtime/conductor.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <deque>
#include <optional>
#include <string>

#include "core/network/graph/check.hpp"
#include "core/network/light/mapped.hpp"
#include "tests/support/learner.hpp"

namespace lightnet::conductor_test {
namespace {

using Nodes = std::vector<Node>;

// Keeps what is asked until somebody answers.
class ByHand final : public Carrier {
public:
    struct Asked {
        PlaceAt place;
        Message message;
        const Step* step() const {
            const auto* steps = std::get_if<Questions<Step>>(&message.questions);
            return steps ? &(*steps)->front() : nullptr;
        }
        bool of_kind(Step::Kind kind) const { return step() && step()->kind == kind; }
        bool of_tiles() const { return std::holds_alternative<Questions<Tile>>(message.questions); }
    };
    bool ask(const PlaceAt& to, Message& message) override {
        asked.push_back({to, message});
        return true;
    }
    void reply(Message) override {}
    std::optional<Message> receive() override {
        if (arrived.empty()) return std::nullopt;
        Message message = std::move(arrived.front());
        arrived.pop_front();
        return message;
    }
    void wait(std::chrono::nanoseconds) override {}
    void forget(const PlaceAt&) override {}
    bool take_out(const std::string& host, const std::string& why) override {
        taken_out.push_back(host + ": " + why);
        return true;
    }
    const Counters& counters() const override { return counters_; }

    Asked take() {
        if (asked.empty()) throw std::runtime_error("nothing was asked");
        Asked first = std::move(asked.front());
        asked.pop_front();
        return first;
    }
    template <class T>
    void answer(Asked to, const T& data) {
        Message message = reply_to(to.message);
        std::vector<std::byte> bytes(sizeof data);
        std::memcpy(bytes.data(), &data, sizeof data);
        message.data = std::make_shared<const std::vector<std::byte>>(std::move(bytes));
        arrived.push_back(std::move(message));
    }
    void answer_tiles(Asked to) { arrived.push_back(reply_to(to.message)); }

    void fail(Asked to, const std::string& why) {
        Message message = reply_to(to.message);
        message.type = Message::Type::failure;
        message.trouble = {why, to.place.host};
        arrived.push_back(std::move(message));
    }

    std::deque<Asked> asked;
    std::deque<Message> arrived;
    std::vector<std::string> taken_out;

private:
    Counters counters_;
};

Node node(std::string name, std::string kind, std::vector<Value> entries, std::map<std::string, Value> params = {}) {
    return {std::move(name), std::move(kind), std::move(entries), std::move(params), {"test.lua", 1}};
}

Query at(std::uint32_t primitive) {
    Query question;
    question.primitive = primitive;
    return question;
}

// A picture by a node that learns from rehearsals.
Graph learning(const Registry& kinds) {
    return check(
        {"test.lua",
         Nodes{node("scene", "Scene", {Value{std::string("none.pbrt")}}), node("direct", "DirectLighting", {}),
               node("learned", "Learner", {Value{NodeRef{"direct"}}}),
               node("image", "RayTracer", {Value{NodeRef{"learned"}}},
                    {{"scene", Value{NodeRef{"scene"}}}, {"film", Value{Table{{Value{24.0}, Value{16.0}}, {}}}}})}},
        kinds);
}

// What one node computes fills the pauses of another that it can't ask; who asks both waits for them.
TEST(Conductor, PreparesNodesThatDoNotAskEachOtherAtTheSameTime) {
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
    Conductor::Options options;
    options.run = 1;
    options.graph = &graph;
    options.registry = &kinds;
    Conductor conductor(options, places);
    const auto lead = [&] { EXPECT_FALSE(conductor.prepare(std::chrono::milliseconds(2))); };
    const auto next = [&](Step::Kind kind, std::size_t node) {
        auto asked = places.take();
        EXPECT_TRUE(asked.of_kind(kind));
        EXPECT_EQ(asked.message.node, node);
        return asked;
    };
    conductor.propose({{{"a", 0}}, std::vector<std::vector<std::uint32_t>>(graph.nodes.size(), {0})});
    auto first = next(Step::Kind::prepare, caustics), second = next(Step::Kind::prepare, global);
    EXPECT_TRUE(places.asked.empty());
    EXPECT_EQ(conductor.progress(), (PrepareProgress{"caustics", 1, 3, 0, 0}));
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
    conductor.propose({{{"a", 0}, {"b", 0}}, std::vector<std::vector<std::uint32_t>>(graph.nodes.size(), {0, 1})});
    const auto late_first = next(Step::Kind::prepare, caustics), late_second = next(Step::Kind::prepare, global);
    EXPECT_EQ(late_first.place.host, "b");
    places.answer(late_first, StepReport{StepReport::Kind::done, 0, 0});
    places.answer(late_second, StepReport{StepReport::Kind::map, 0, 1});
    lead();
    places.answer(next(Step::Kind::go_on, global), StepReport{StepReport::Kind::done, 1, 0});
    lead();
    EXPECT_TRUE(places.asked.empty());
    places.answer(std::move(first), StepReport{StepReport::Kind::done, 0, 0});
    lead();
    next(Step::Kind::prepare, learned);
    next(Step::Kind::prepare, learned);
    EXPECT_TRUE(places.asked.empty());
}

// A host leaves after all tiles of a rehearsal are rendered. The rehearsal begins again; what another host still says
// of the first one comes in its middle.
TEST(Conductor, TakesNoNotesOfARehearsalThatWasBrokenOff) {
    const Registry kinds = test::with_learner();
    const Graph graph = learning(kinds);
    Plan both{{{"a", 0}, {"b", 0}}, std::vector<std::vector<std::uint32_t>>(graph.nodes.size(), {0, 1})};
    const Plan alone{{{"a", 0}}, std::vector<std::vector<std::uint32_t>>(graph.nodes.size(), {0})};
    ByHand places;
    Conductor::Options options;
    options.run = 1;
    options.graph = &graph;
    options.registry = &kinds;
    Conductor conductor(options, places);
    const auto lead = [&] { EXPECT_FALSE(conductor.prepare(std::chrono::milliseconds(2))); };

    conductor.propose(both);
    const StepReport rehearses{StepReport::Kind::rehearse, 0, 4};
    for (int i = 0; i < 2; ++i) {
        auto prepare = places.take();
        ASSERT_TRUE(prepare.of_kind(Step::Kind::prepare));
        places.answer(std::move(prepare), rehearses);
    }
    lead();
    auto tiles = places.take();
    ASSERT_TRUE(tiles.of_tiles());
    const auto before = conductor.progress();
    EXPECT_EQ(before.node, "learned");
    EXPECT_GT(before.total, 0u) << "how far a rehearsal is can be told";
    EXPECT_EQ(before.done, 0u);
    places.answer_tiles(std::move(tiles));
    lead();
    EXPECT_EQ(conductor.progress().done, before.total);
    auto collect = places.take();
    ASSERT_TRUE(collect.of_kind(Step::Kind::collect));
    ASSERT_EQ(collect.place.host, "a");
    ASSERT_TRUE(places.take().of_kind(Step::Kind::collect));

    conductor.propose(alone);
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
        Conductor::Options options;
        options.run = 1;
        options.graph = &graph;
        options.registry = &kinds;
        conductor.emplace(options, places);
        conductor->propose({{{"a", 0}, {"b", 0}}, std::vector<std::vector<std::uint32_t>>(graph.nodes.size(), {0, 1})});
    }
    void lead() { EXPECT_FALSE(conductor->prepare(std::chrono::milliseconds(2))); }

    Registry kinds = test::with_learner();
    Graph graph = check(
        {"test.lua",
         Nodes{node("scene", "Scene", {Value{std::string("none.pbrt")}}), node("caustics", "PhotonMap", {}),
               node("image", "RayTracer", {Value{NodeRef{"caustics"}}},
                    {{"scene", Value{NodeRef{"scene"}}}, {"film", Value{Table{{Value{24.0}, Value{16.0}}, {}}}}})}},
        kinds);
    ByHand places;
    std::optional<Conductor> conductor;
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
        conductor->prepare(std::chrono::milliseconds(2));
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

// Two epochs for each rehearsal: one of it, and one of what follows it.
TEST(Conductor, TakesRepliesAfterMoreRehearsalsThanThereAreEpochs) {
    const Registry kinds = test::with_learner();
    const Graph graph = learning(kinds);
    ByHand places;
    Conductor::Options options;
    options.run = 1;
    options.graph = &graph;
    options.registry = &kinds;
    Conductor conductor(options, places);
    const auto lead = [&] { EXPECT_FALSE(conductor.prepare(std::chrono::microseconds(50))); };
    for (std::uint32_t rehearsal = 0; rehearsal < Epoch::count / 2 + 2; ++rehearsal) {
        // Each host stays for one rehearsal, which is broken off when the next one has taken its place.
        conductor.propose(
            {{{std::to_string(rehearsal), 0}}, std::vector<std::vector<std::uint32_t>>(graph.nodes.size(), {0})});
        auto prepare = places.take();
        ASSERT_TRUE(prepare.of_kind(Step::Kind::prepare)) << rehearsal;
        places.answer(std::move(prepare), StepReport{StepReport::Kind::rehearse, 0, 4});
        for (int patience = 0; places.asked.empty() && patience < 1000; ++patience) lead();
        ASSERT_FALSE(places.asked.empty()) << "nobody is asked for the tiles of rehearsal " << rehearsal;
        auto tiles = places.take();
        ASSERT_TRUE(tiles.of_tiles()) << rehearsal;
        if (rehearsal % 64 && rehearsal + 4 < Epoch::count / 2) continue;
        places.answer_tiles(std::move(tiles));
        for (int patience = 0; places.asked.empty() && patience < 1000; ++patience) lead();
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
}  // namespace lightnet::conductor_test
