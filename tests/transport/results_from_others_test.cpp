// Results that a host gets from others that have them.
#include "transport/daemon/results_from_others.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

namespace lightnet::results_from_others_test {
namespace {

using namespace std::chrono_literals;
using Asks = std::deque<ResultsFromOthers::Ask>;

std::vector<std::byte> some_bytes(std::size_t size) {
    std::vector<std::byte> bytes(size);
    for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::byte>(i * 2654435761u >> 13);
    return bytes;
}

class ResultsFromOthersTest : public ::testing::Test {
protected:
    void go_on() {
        results.go_on(now, [this](const auto& ask) {
            if (ask.host == unreachable) return false;
            asks.push_back(ask);
            return true;
        });
    }
    // The first that was asked, if it is of this host.
    bool give(const std::string& host, std::uint8_t changed = 0) {
        if (asks.empty() || asks.front().host != host) return false;
        const auto ask = asks.front();
        asks.pop_front();
        std::vector<std::byte> piece(whole.begin() + std::ptrdiff_t(ask.offset),
                                     whole.begin() + std::ptrdiff_t(ask.offset + ask.size));
        piece.back() ^= static_cast<std::byte>(changed);
        results.take(host, {ask.hash, ask.offset, piece}, now);
        return true;
    }
    void give_all(const std::string& host) {
        for (int pieces = 0; pieces < 10000; ++pieces) {
            go_on();
            if (!give(host)) return;
            now += 1ms;
        }
    }
    void expect_left_to_launcher() {
        const auto outcomes = results.outcomes();
        ASSERT_EQ(outcomes.size(), 1u);
        EXPECT_EQ(outcomes[0].hash, hash);
        EXPECT_EQ(outcomes[0].bytes, nullptr);
        EXPECT_FALSE(results.waits());
    }
    void expect_here() {
        const auto outcomes = results.outcomes();
        ASSERT_EQ(outcomes.size(), 1u);
        ASSERT_NE(outcomes[0].bytes, nullptr);
        EXPECT_EQ(*outcomes[0].bytes, whole);
        EXPECT_FALSE(results.waits());
    }

    std::vector<std::byte> whole = some_bytes(3'000'001);
    Hash hash = content_hash(whole);
    ResultsFromOthers results;
    ResultsFromOthers::Time now{1h};
    Asks asks;
    std::string unreachable;
};

TEST_F(ResultsFromOthersTest, ComeInPiecesFromTheFirst) {
    results.want(hash, whole.size(), {"near", "far"});
    give_all("near");
    expect_here();
    EXPECT_TRUE(results.troubles().empty());
    EXPECT_TRUE(asks.empty()) << "nobody else is asked";
}

TEST_F(ResultsFromOthersTest, NeverHaveMoreUnderWayThanTheLineTakes) {
    results.want(hash, whole.size(), {"near"});
    go_on();
    std::uint64_t asked = 0;
    for (const auto& ask : asks) asked += ask.size;
    EXPECT_GT(asked, 0u);
    EXPECT_LE(asked, 32u << 10) << "nothing is known of the line yet";
}

TEST_F(ResultsFromOthersTest, ComeFromTheNextWhenAHolderIsLostInTheMiddle) {
    results.want(hash, whole.size(), {"near", "far"});
    go_on();
    ASSERT_TRUE(give("near"));
    results.lose("near");
    asks.clear();
    give_all("far");
    expect_here();
}

TEST_F(ResultsFromOthersTest, AreLeftToTheLauncherWhenAllHoldersAreLost) {
    results.want(hash, whole.size(), {"near"});
    go_on();
    ASSERT_TRUE(give("near"));
    results.lose("near");
    expect_left_to_launcher();
}

TEST_F(ResultsFromOthersTest, AreTakenFromNobodyWhoLiesAgain) {
    results.want(hash, whole.size(), {"liar", "far"});
    go_on();
    ASSERT_TRUE(give("liar", 1));
    give_all("liar");
    ASSERT_EQ(results.troubles().size(), 1u);
    EXPECT_TRUE(results.outcomes().empty()) << "the next one is asked first";
    give_all("far");
    expect_here();
    results.want(content_hash(some_bytes(7)), 7, {"liar"});
    EXPECT_EQ(results.outcomes().size(), 1u) << "the launcher, at once";
}

TEST_F(ResultsFromOthersTest, AreTakenFromNobodyWhoGivesMoreThanHeWasAsked) {
    results.want(hash, whole.size(), {"liar"});
    go_on();
    results.take("liar", {hash, 0, whole}, now);
    expect_left_to_launcher();
    EXPECT_EQ(results.troubles().size(), 1u);
}

TEST_F(ResultsFromOthersTest, DoNotWaitForWhoIsSilent) {
    results.want(hash, whole.size(), {"silent"});
    go_on();
    now += 1s;
    go_on();
    EXPECT_TRUE(results.waits()) << "it may be busy";
    now += 2s;
    go_on();
    expect_left_to_launcher();
}

TEST_F(ResultsFromOthersTest, DoNotWaitForWhoIsFarTooSlow) {
    results.want(hash, whole.size(), {"slow"});
    auto given = 0;
    for (; given < 100 && results.waits(); ++given) {
        go_on();
        give("slow");
        now += 500ms;
    }
    EXPECT_LT(given, 12) << "a few seconds";
    expect_left_to_launcher();
}

TEST_F(ResultsFromOthersTest, ComeFromTheNextWhenAHolderHasThemNoMore) {
    results.want(hash, whole.size(), {"near", "far"});
    go_on();
    results.lacks("near", hash);
    asks.clear();
    give_all("far");
    expect_here();
    results.want(hash, whole.size(), {"near"});
    go_on();
    EXPECT_TRUE(results.waits()) << "it is no worse for that";
}

TEST_F(ResultsFromOthersTest, AreLeftToTheLauncherWhereNoHolderCanBeCalled) {
    unreachable = "far";
    results.want(hash, whole.size(), {"far"});
    go_on();
    expect_left_to_launcher();
    results.want(hash, whole.size(), {});
    expect_left_to_launcher();
}

TEST_F(ResultsFromOthersTest, IgnoreWhatNobodyAskedFor) {
    results.take("stranger", {hash, 0, whole}, now);
    results.want(hash, whole.size(), {"near"});
    go_on();
    results.take("stranger", {hash, 0, whole}, now);
    results.lacks("stranger", hash);
    give_all("near");
    expect_here();
}

// Two at a time would overtake each other.
TEST_F(ResultsFromOthersTest, ComeOneAfterAnotherFromOneHost) {
    const auto first = whole, second = some_bytes(500'000);
    results.want(hash, whole.size(), {"near"});
    results.want(content_hash(second), second.size(), {"near"});
    go_on();
    EXPECT_TRUE(std::ranges::all_of(asks, [&](const auto& ask) { return ask.hash == hash; }));
    give_all("near");  // the second begins as the first does
    const auto outcomes = results.outcomes();
    ASSERT_EQ(outcomes.size(), 2u);
    EXPECT_EQ(*outcomes[0].bytes, first);
    EXPECT_EQ(*outcomes[1].bytes, second);
}

}  // namespace
}  // namespace lightnet::results_from_others_test
