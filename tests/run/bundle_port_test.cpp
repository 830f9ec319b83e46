#include "core/run/place/bundle_port.hpp"

#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "tests/support/fake_channel.hpp"

namespace lightnet::bundle_port_test {
namespace {

using test::FakeChannel;

// A port whose bundles go to a channel that the test answers by hand.
class BundlePortTest : public ::testing::Test {
protected:
    BundlePortTest() { port.replicas().use({&channel}); }
    ~BundlePortTest() override { fibers.cancel_all(); }

    std::vector<Query> questions(std::uint32_t count) {
        std::vector<Query> queries(count);
        for (auto& query : queries) query.sample = next++;
        return queries;
    }
    // Asks in a fiber of its own, and checks the answers when they are there.
    void ask(std::uint32_t count) {
        fibers.start("asker", [this, count] {
            const auto queries = questions(count);
            std::vector<Rgb> answers(queries.size());
            port.finish(port.begin(queries, answers));
            for (std::size_t i = 0; i < queries.size(); ++i)
                EXPECT_EQ(answers[i].r, static_cast<float>(queries[i].sample));
            ++answered;
        });
    }
    void run_ready() {
        while (!ready.empty()) {
            auto* fiber = ready.back();
            ready.pop_back();
            fibers.resume(fiber);
        }
    }
    bool flush_idle() { return port.flush(BundlePort::Clock::now(), true); }
    // After `passed` seconds of the system's clock, of which the place has had `had`.
    bool flush_after(double passed, double had) {
        own = seconds(had);
        return port.flush(begun + seconds(passed), false);
    }
    static std::chrono::nanoseconds seconds(double count) {
        return std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 * count));
    }

    Fibers fibers;
    std::vector<Fibers::Fiber*> ready;
    FakeChannel<Query> channel;
    BundleRules rules{8, std::chrono::microseconds(1000000), 2};
    const BundlePort::Clock::time_point begun = BundlePort::Clock::now();
    std::chrono::nanoseconds own{0};  // that the place has had
    BundlePort port{fibers, [this](Fibers::Fiber* fiber) { ready.push_back(fiber); }, 1, rules, [this] { return own; }};
    std::uint32_t next = 0;
    int answered = 0;
};

TEST_F(BundlePortTest, GathersTheQuestionsOfSeveralAskersInOneBundle) {
    ask(2);
    ask(3);
    EXPECT_TRUE(channel.sent.empty()) << "not full, and not idle";
    EXPECT_TRUE(flush_idle());
    ASSERT_EQ(channel.sent.size(), 1u);
    EXPECT_EQ(channel.sent.front().questions->size(), 5u);
    channel.answer();
    run_ready();
    EXPECT_EQ(answered, 2);
}

TEST_F(BundlePortTest, SendsFullBundlesAtOnceAndSplitsLongAsks) {
    ask(20);
    ASSERT_EQ(channel.sent.size(), 2u);
    EXPECT_EQ(channel.sent[0].questions->size(), 8u);
    channel.answer();
    channel.answer();
    flush_idle();
    ASSERT_EQ(channel.sent.size(), 1u);
    EXPECT_EQ(answered, 0);
    channel.answer();
    run_ready();
    EXPECT_EQ(answered, 1);
}

TEST_F(BundlePortTest, AsksAgainWhatCameBackUnanswered) {
    ask(3);
    flush_idle();
    auto lost = channel.take();
    lost.owner->returned(lost);
    EXPECT_TRUE(port.flush(BundlePort::Clock::now(), false)) << "it is due at once";
    channel.answer();
    run_ready();
    EXPECT_EQ(answered, 1);
}

TEST_F(BundlePortTest, KeepsABundleThatTheChannelRefuses) {
    channel.refuse = true;
    ask(8);
    EXPECT_TRUE(channel.sent.empty());
    channel.refuse = false;
    flush_idle();
    channel.answer();
    run_ready();
    EXPECT_EQ(answered, 1);
}

TEST_F(BundlePortTest, WaitsWhileTwoSmallBundlesAreOut) {
    ask(1), flush_idle();
    ask(1), flush_idle();
    ask(1), flush_idle();
    EXPECT_EQ(channel.sent.size(), 2u) << "replies that come back in pieces would fragment the next bundles";
}

TEST_F(BundlePortTest, ThrowsWhereTheAnswerWasAwaited) {
    std::string what;
    fibers.start("asker", [&] {
        const auto queries = questions(2);
        std::vector<Rgb> answers(2);
        const auto ticket = port.begin(queries, answers);
        try {
            port.finish(ticket);
        } catch (const Error& error) {
            what = error.what();
        }
    });
    flush_idle();
    const auto bundle = channel.take();
    bundle.owner->failed(bundle, {"'bounce' on onyx2: out of photons", "onyx2"});
    run_ready();
    EXPECT_EQ(what, "'bounce' on onyx2: out of photons");
}

TEST_F(BundlePortTest, SendsWhatHasWaitedForLong) {
    ask(1);
    EXPECT_FALSE(flush_after(.5, .5));
    EXPECT_TRUE(flush_after(2, 2));
    channel.answer();
    run_ready();
}

TEST_F(BundlePortTest, WaitsForAsLongAsItsPlaceHasHadATurn) {
    ask(1);
    EXPECT_FALSE(flush_after(20, .3)) << "other programs had the processor: nobody could have asked meanwhile";
    ask(1);
    EXPECT_FALSE(flush_after(40, .6));
    EXPECT_TRUE(flush_after(60, 1.1));
    ASSERT_EQ(channel.sent.size(), 1u);
    EXPECT_EQ(channel.sent.front().questions->size(), 2u);
    channel.answer();
    run_ready();
}

TEST_F(BundlePortTest, WaitsLongerForCompanyWhereAnswersTakeLong) {
    ask(1);
    port.flush(begun - seconds(10), true);  // sent so long ago
    channel.answer();
    run_ready();
    ask(1);
    EXPECT_FALSE(flush_after(2, 2)) << "five seconds are half of what the last answer took";
    EXPECT_TRUE(flush_after(6, 6));
    channel.answer();
    run_ready();
}

// On a simulated clock a place has a turn of a tenth of a millisecond, and others of the machine none or nineteen;
// every second turn it asks.
TEST_F(BundlePortTest, SendsAsFewBundlesWhereOthersHaveTheProcessor) {
    const auto bundles_beside = [&](int others) {
        BundlePort lone{fibers,
                        [this](Fibers::Fiber* fiber) { ready.push_back(fiber); },
                        1,
                        {64, std::chrono::microseconds(3000), 2},
                        [this] { return own; }};
        FakeChannel<Query> far;
        lone.replicas().use({&far});
        std::size_t bundles = 0;
        auto now = BundlePort::Clock::now();
        for (int step = 0; step < 400; ++step) {  // each a tenth of a millisecond of the place's own
            if (step % 2 == 0)
                fibers.start("asker", [&] {
                    const auto queries = questions(1);
                    std::vector<Rgb> answers(1);
                    lone.finish(lone.begin(queries, answers));
                });
            own += std::chrono::microseconds(100);
            now += std::chrono::microseconds(100) * (1 + others);
            lone.flush(now, false);
            bundles += far.sent.size();
            while (!far.sent.empty()) far.answer();
            run_ready();
        }
        lone.flush(now, true);
        while (!far.sent.empty()) far.answer();
        run_ready();
        return bundles;
    };
    const auto alone = bundles_beside(0);
    EXPECT_GT(alone, 5u);
    EXPECT_EQ(bundles_beside(19), alone);
}

TEST_F(BundlePortTest, SendsNoLessAtOnceWhereAnswersWaitLongAndAreLittleWork) {
    FakeChannel<Query> busy(1000, 1000);  // a microsecond of work each
    BundlePort to_busy{fibers, [this](Fibers::Fiber* fiber) { ready.push_back(fiber); }, 1, rules,
                       [this] { return own; }};
    double now = 0;
    MultiplexerRules by_hand;
    by_hand.clock = [&now] { return now; };
    to_busy.replicas().follow(by_hand);
    to_busy.replicas().use({&busy});
    const auto ask_it = [&](std::uint32_t count) {
        fibers.start("asker", [&, count] {
            const auto queries = questions(count);
            std::vector<Rgb> answers(queries.size());
            to_busy.finish(to_busy.begin(queries, answers));
        });
    };
    ask_it(1);
    to_busy.flush(BundlePort::Clock::now(), true);
    now = 1;  // others were answered first
    busy.answer();
    run_ready();
    ask_it(8);
    ASSERT_EQ(busy.sent.size(), 1u);
    EXPECT_EQ(busy.sent.front().questions->size(), 8u);
    busy.answer();
    run_ready();
}

TEST_F(BundlePortTest, UsesItsBuffersAgain) {
    ask(8);
    const auto* const first = channel.sent.front().questions->data();
    channel.answer();
    run_ready();
    ask(8);
    EXPECT_EQ(channel.sent.front().questions->data(), first);
    const auto kept = channel.sent.front().questions;  // somebody still reads it when the answer is there
    channel.answer();
    run_ready();
    ask(8);
    EXPECT_NE(channel.sent.front().questions->data(), first);
    channel.answer();
    run_ready();
    EXPECT_EQ(answered, 3);
}

TEST_F(BundlePortTest, TakesTheFirstOfTwoAnswersToABundle) {
    ask(8);
    const auto bundle = channel.sent.front();
    channel.answer();
    run_ready();
    ask(8);
    bundle.owner->answered(bundle, std::vector<Rgb>(8, Rgb{9, 9, 9}));
    EXPECT_EQ(answered, 1);
    channel.answer();
    run_ready();
    EXPECT_EQ(answered, 2);
}

TEST_F(BundlePortTest, ForgetsAnAskThatWasGivenUp) {
    {
        const auto queries = questions(8);
        std::vector<Rgb> answers(8);
        port.abandon(port.begin(queries, answers));
    }
    ask(8);
    channel.answer();  // writes nowhere
    channel.answer();
    run_ready();
    EXPECT_EQ(answered, 1);
}

}  // namespace
}  // namespace lightnet::bundle_port_test
