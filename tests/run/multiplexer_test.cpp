#include "core/run/schedule/multiplexer.hpp"

#include <gtest/gtest.h>

#include "tests/support/fake_channel.hpp"

namespace lightnet::multiplexer_test {
namespace {

using test::FakeChannel;

// Gets bundles back and remembers how.
template <class Question>
struct Owner final : BundleOwner<Question> {
    void answered(const Bundle<Question>& bundle, std::vector<Rgb> colours) override {
        numbers.push_back(bundle.number);
        answers.push_back(std::move(colours));
    }
    void failed(const Bundle<Question>&, const Failure& failure) override { failures.push_back(failure.why); }
    void returned(Bundle<Question>) override { FAIL() << "a multiplexer keeps what it has taken"; }
    void set_aside(const Bundle<Question>&, const std::string& why) override { aside.push_back(why); }

    std::vector<std::uint64_t> numbers;
    std::vector<std::vector<Rgb>> answers;
    std::vector<std::string> failures, aside;
};

class MultiplexerTest : public ::testing::Test {
protected:
    Bundle<Query> bundle_of(std::size_t questions) {
        auto queries = std::make_shared<std::vector<Query>>(questions);
        for (std::size_t i = 0; i < questions; ++i) {
            (*queries)[i].sample = static_cast<std::uint32_t>(i);
            (*queries)[i].geometry = static_cast<std::uint32_t>(i % 16);
        }
        return {std::move(queries), &owner, ++number, 1};
    }
    MultiplexerRules rules(Strategy strategy = Strategy::fastest) {
        MultiplexerRules rules;
        rules.clock = [this] { return now; };
        rules.scheduling.strategy = strategy;
        return rules;
    }
    double now = 0;
    std::uint64_t number = 0;
    Owner<Query> owner;
    Counters counters;
};

TEST_F(MultiplexerTest, AsksTheReplicaThatWillFinishFirst) {
    FakeChannel<Query> slow(1000, 4000), fast(1000, 1000);
    Multiplexer<Query> replicas({&slow, &fast}, rules());
    for (int i = 0; i < 2; ++i) replicas.send(bundle_of(1));
    slow.answer(), fast.answer();  // now their speeds are known
    for (int i = 0; i < 10; ++i) replicas.send(bundle_of(1));
    EXPECT_EQ(slow.sent.size(), 2u);
    EXPECT_EQ(fast.sent.size(), 8u);
}

TEST_F(MultiplexerTest, KeepsWhatNoReplicaHasCreditFor) {
    FakeChannel<Query> only(1);
    Multiplexer<Query> replicas({&only}, rules());
    EXPECT_TRUE(replicas.has_credit());
    replicas.send(bundle_of(1)), replicas.send(bundle_of(2));
    EXPECT_FALSE(replicas.has_credit());
    EXPECT_EQ(only.sent.size(), 1u);
    only.answer();
    EXPECT_TRUE(replicas.tick());
    only.answer();
    EXPECT_EQ(owner.numbers, (std::vector<std::uint64_t>{1, 2}));
}

TEST_F(MultiplexerTest, TriesTheNextReplicaWhenOneRefuses) {
    FakeChannel<Query> broken, good;
    broken.refuse = true;
    Multiplexer<Query> replicas({&broken, &good}, rules());
    replicas.send(bundle_of(1));
    EXPECT_EQ(good.sent.size(), 1u);
}

TEST_F(MultiplexerTest, AsksAgainElsewhereWhatALostReplicaHad) {
    FakeChannel<Query> lost(1000, 1), other(1000, 1);
    Multiplexer<Query> replicas;
    replicas.follow(rules(), &counters);
    replicas.use({&lost});
    replicas.send(bundle_of(3));
    replicas.use({&other});
    EXPECT_TRUE(replicas.tick());
    other.answer();
    EXPECT_EQ(owner.numbers.size(), 1u);
    EXPECT_EQ(counters.asked_again, 1u);
    lost.answer();
    EXPECT_EQ(owner.numbers.size(), 1u) << "this answer comes too late";
    EXPECT_EQ(counters.late_replies, 1u);
}

TEST_F(MultiplexerTest, LetsADrainingReplicaFinishAndAsksItNoMore) {
    FakeChannel<Query> leaving, staying;
    Multiplexer<Query> replicas({&leaving}, rules());
    replicas.send(bundle_of(1));
    replicas.use({&leaving, &staying}, {&leaving});
    replicas.send(bundle_of(1));
    EXPECT_EQ(leaving.sent.size(), 1u);
    EXPECT_EQ(staying.sent.size(), 1u);
    leaving.answer();
    EXPECT_EQ(owner.numbers, (std::vector<std::uint64_t>{1}));
}

TEST_F(MultiplexerTest, CutsALargeCostlyBundleForIdleReplicasAndPutsItsAnswersTogether) {
    FakeChannel<Query> a(1000, 100000), b(1000, 100000);
    Multiplexer<Query> replicas;
    replicas.follow(rules(), &counters);
    replicas.use({&a, &b});
    replicas.send(bundle_of(1)), replicas.send(bundle_of(1));
    a.answer(), b.answer();
    replicas.send(bundle_of(200));
    ASSERT_EQ(a.sent.size(), 1u);
    ASSERT_EQ(b.sent.size(), 1u);
    EXPECT_EQ(counters.cut_bundles, 1u);
    b.answer(), a.answer();
    ASSERT_EQ(owner.answers.size(), 3u);
    ASSERT_EQ(owner.answers[2].size(), 200u);
    for (std::size_t i = 0; i < 200; ++i) EXPECT_EQ(owner.answers[2][i].r, static_cast<float>(i));
}

TEST_F(MultiplexerTest, GivesEachReplicaTheQuestionsOfItsRegions) {
    FakeChannel<Query> a, b;
    Multiplexer<Query> replicas({&a, &b}, rules(Strategy::affinity));
    for (int i = 0; i < 3; ++i) replicas.send(bundle_of(512));
    std::map<std::uint32_t, std::set<FakeChannel<Query>*>> homes;
    for (auto* channel : {&a, &b})
        for (const auto& bundle : channel->sent)
            for (const auto& query : *bundle.questions) homes[query.geometry].insert(channel);
    ASSERT_FALSE(a.sent.empty());
    ASSERT_FALSE(b.sent.empty());
    for (const auto& [geometry, where] : homes) EXPECT_EQ(where.size(), 1u) << geometry;
    while (!a.sent.empty()) a.answer();
    while (!b.sent.empty()) b.answer();
    ASSERT_EQ(owner.answers.size(), 3u);
    for (std::size_t i = 0; i < 512; ++i) EXPECT_EQ(owner.answers[0][i].r, static_cast<float>(i));
}

TEST_F(MultiplexerTest, FailsABundleWhoseAnswerHasAWrongSize) {
    FakeChannel<Query> only;
    Multiplexer<Query> replicas({&only}, rules());
    replicas.send(bundle_of(3));
    const auto bundle = only.take();
    bundle.owner->answered(bundle, std::vector<Rgb>(2));
    ASSERT_EQ(owner.failures.size(), 1u);
}

TEST_F(MultiplexerTest, AsksAnotherHostWhenOneFailsOrAnswersWrongly) {
    for (const bool wrong_size : {false, true}) {
        FakeChannel<Query> a, b;
        auto telling = rules();
        std::vector<Failure> told;
        telling.at_fault = [&](const Failure& failure) { told.push_back(failure); };
        Multiplexer<Query> replicas({&a, &b}, std::move(telling));
        replicas.send(bundle_of(3));
        auto& sick = a.sent.empty() ? b : a;
        auto& healthy = a.sent.empty() ? a : b;
        const auto bundle = sick.take();
        if (wrong_size)
            bundle.owner->answered(bundle, std::vector<Rgb>(2));
        else
            bundle.owner->failed(bundle, {"out of memory", sick.where});
        replicas.tick();
        ASSERT_EQ(healthy.sent.size(), 1u);
        healthy.answer();
        EXPECT_TRUE(owner.failures.empty());
        ASSERT_EQ(told.size(), 1u);
        EXPECT_EQ(told[0].host, sick.where) << "so that it gets no more";
    }
    EXPECT_EQ(owner.answers.size(), 2u);
}

TEST_F(MultiplexerTest, SaysWhatTwoHostsFailedAt) {
    FakeChannel<Query> a, b;
    Multiplexer<Query> replicas({&a, &b}, rules());
    replicas.send(bundle_of(3));
    for (int host = 0; host < 2; ++host) {
        auto& asked = a.sent.empty() ? b : a;
        const auto bundle = asked.take();
        bundle.owner->failed(bundle, {"'bounce': no photons", asked.where});
        replicas.tick();
    }
    ASSERT_EQ(owner.failures.size(), 1u);
    EXPECT_EQ(owner.failures[0], "'bounce': no photons");
}

TEST_F(MultiplexerTest, ComparesAnswersThatComeTwiceBitForBit) {
    FakeChannel<Query> first, second;
    auto checking = rules();
    std::string said;
    checking.differs = [&](const std::string& what) { said = what; };
    Multiplexer<Query> replicas;
    replicas.follow(std::move(checking), &counters);
    replicas.use({&first, &second});
    replicas.send(bundle_of(1));
    now = 1000;  // overdue
    replicas.tick();
    ASSERT_EQ(first.sent.size() + second.sent.size(), 2u);
    first.answer();
    const auto bundle = second.take();
    bundle.owner->answered(bundle, {Rgb{1, 2, 3}});
    EXPECT_EQ(owner.numbers.size(), 1u);
    EXPECT_EQ(counters.compared, 1u);
    EXPECT_NE(said.find("differently"), std::string::npos);
}

TEST_F(MultiplexerTest, NamesTheBundleThatIsSetAsideAndTheHostsThatDiedOfIt) {
    FakeChannel<Query> one, two, three;
    one.where = "onyx1", two.where = "onyx2", three.where = "onyx3";
    Multiplexer<Query> replicas({&one}, rules());
    replicas.send(bundle_of(1));
    replicas.use({&two}), replicas.tick();
    replicas.use({&three}), replicas.tick();
    replicas.use({});
    ASSERT_EQ(owner.aside.size(), 1u);
    EXPECT_NE(owner.aside[0].find("shape 0"), std::string::npos) << owner.aside[0];
    EXPECT_NE(owner.aside[0].find("onyx1, onyx2, onyx3"), std::string::npos) << owner.aside[0];
}

TEST_F(MultiplexerTest, AsksInHalvesWhatWasLostTwiceOnTheWayToAHostThatLives) {
    FakeChannel<Tile> far;
    far.number = 17;
    Owner<Tile> tiles;
    Multiplexer<Tile> replicas({&far}, rules());
    auto wanted = std::make_shared<std::vector<Tile>>();
    for (std::uint32_t i = 0; i < 4; ++i) wanted->push_back(Tile{i, 0, 1 + i, 1, 0, 1});
    replicas.send({wanted, &tiles, 5, 1});
    for (const std::size_t size : {4, 4, 2, 2, 1}) {
        ASSERT_FALSE(far.sent.empty());
        EXPECT_EQ(far.sent.front().questions->size(), size);
        replicas.use({}), far.sent.clear();  // the line is cut
        replicas.use({&far}), replicas.tick();
    }
    // Each answer bears the number of its tile.
    for (std::size_t pieces = 0; tiles.numbers.empty() && pieces < 4; ++pieces) {
        const auto bundle = far.take();
        std::vector<Rgb> answers;
        for (const auto& tile : *bundle.questions)
            answers.insert(answers.end(), tile.pixels(), Rgb{float(tile.x), 0, 0});
        bundle.owner->answered(bundle, std::move(answers));
    }
    ASSERT_EQ(tiles.numbers, std::vector<std::uint64_t>{5});
    std::size_t at = 0;
    for (const auto& tile : *wanted)
        for (std::uint32_t pixel = 0; pixel < tile.pixels(); ++pixel)
            EXPECT_EQ(tiles.answers[0].at(at++).r, float(tile.x));
}

TEST_F(MultiplexerTest, LeavesWholeWhatWasLostWithAProcess) {
    FakeChannel<Query> far;
    Multiplexer<Query> replicas({&far}, rules());
    replicas.send(bundle_of(100));
    for (far.number = 1; far.number < 3; ++far.number) {
        EXPECT_EQ(far.sent.front().questions->size(), 100u);
        replicas.use({}), far.sent.clear();
        replicas.use({&far}), replicas.tick();
    }
}

TEST_F(MultiplexerTest, IsItselfAChannelAndNests) {
    FakeChannel<Query> a, b, c;
    Multiplexer<Query> pair({&a, &b}, rules());
    Multiplexer<Query> all({&pair, &c}, rules());
    for (int i = 0; i < 8; ++i) all.send(bundle_of(1));
    EXPECT_EQ(all.places(), 3u);
    EXPECT_EQ(a.sent.size() + b.sent.size(), 5u) << "two places, and so nearly two thirds";
    EXPECT_EQ(c.sent.size(), 3u);
    while (!a.sent.empty()) a.answer();
    while (!b.sent.empty()) b.answer();
    while (!c.sent.empty()) c.answer();
    EXPECT_EQ(owner.numbers.size(), 8u);
    EXPECT_EQ(all.outstanding(), 0u);
}

TEST_F(MultiplexerTest, ServesRenderingAsItServesLight) {
    FakeChannel<Tile> only;
    Owner<Tile> tiles;
    Multiplexer<Tile> replicas({&only}, rules());
    replicas.send({std::make_shared<const std::vector<Tile>>(1, Tile{0, 0, 2, 2, 0, 1}), &tiles, 0, 1});
    const auto bundle = only.take();
    bundle.owner->answered(bundle, std::vector<Rgb>(4));
    EXPECT_EQ(tiles.numbers.size(), 1u);
}

}  // namespace
}  // namespace lightnet::multiplexer_test
