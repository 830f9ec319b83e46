// Which address is called next.
#include "transport/address/address_turns.hpp"

#include <gtest/gtest.h>

namespace lightnet::address_turns_test {
namespace {

using namespace std::chrono_literals;

class Turns : public ::testing::Test {
protected:
    std::string due() { return turns.due(now).value_or(IpAddress{}).text(); }
    static std::vector<IpAddress> addresses(const std::vector<std::string>& texts) {
        std::vector<IpAddress> all;
        for (const auto& text : texts) all.push_back(*ip_address(text));
        return all;
    }
    AddressTurns::Time now{1h};
    AddressTurns turns;
};

TEST_F(Turns, GoOnAtOnceWhereSomebodySaysNo) {
    turns.use(addresses({"10.0.0.1", "fd00::1"}), now);
    EXPECT_EQ(due(), "10.0.0.1");
    turns.refused();
    EXPECT_EQ(due(), "fd00::1");
    turns.answered();
    now += 1h;
    EXPECT_EQ(due(), "fd00::1") << "who answers stays";
}

TEST_F(Turns, GoOnAfterAWhileWhereNobodySaysAnything) {
    turns.use(addresses({"10.0.0.1", "10.0.0.2"}), now);
    EXPECT_EQ(due(), "10.0.0.1");
    now += 100ms;
    EXPECT_EQ(due(), "10.0.0.1");
    now += 1s;
    EXPECT_EQ(due(), "10.0.0.2");
    now += 1s;
    EXPECT_EQ(due(), "10.0.0.1") << "the next round";
    now += 700ms;
    EXPECT_EQ(due(), "10.0.0.1") << "which has more patience: the line may be slow";
    now += 700ms;
    EXPECT_EQ(due(), "10.0.0.2");
}

TEST_F(Turns, DontRushThroughRoundsWhereAllSayNo) {
    turns.use(addresses({"10.0.0.1", "10.0.0.2"}), now);
    int calls = 1;
    auto last = due();
    for (const auto end = now + 10s; now < end; now += 10ms) {
        turns.refused();
        calls += due() != last;
        last = due();
    }
    EXPECT_LT(calls, 60);
    EXPECT_GT(calls, 10) << "but they go on";
}

TEST_F(Turns, HaveMorePatienceWithASlowOneThoughAnotherSaysNo) {
    turns.use(addresses({"10.0.0.1", "10.0.0.2"}), now);
    EXPECT_EQ(due(), "10.0.0.1");
    now += 600ms;
    EXPECT_EQ(due(), "10.0.0.2");
    turns.refused();
    EXPECT_EQ(due(), "10.0.0.1");
    now += 900ms;
    EXPECT_EQ(due(), "10.0.0.1");
}

TEST_F(Turns, StayWithTheOnlyOne) {
    turns.use(addresses({"10.0.0.1"}), now);
    turns.refused();
    now += 1h;
    EXPECT_EQ(due(), "10.0.0.1") << "ZeroMQ itself calls again";
}

TEST_F(Turns, GoWhereTheNameGoes) {
    turns.use(addresses({"10.0.0.1"}), now);
    turns.answered();
    turns.use(addresses({"10.0.0.9"}), now);
    EXPECT_EQ(due(), "10.0.0.1") << "a connection that lives is not cut";
    turns.cut(now);
    turns.use(addresses({"10.0.0.9"}), now);
    EXPECT_EQ(due(), "10.0.0.9");
}

TEST_F(Turns, DontMindTheOrderInWhichServersAnswer) {
    turns.use(addresses({"10.0.0.1", "10.0.0.2", "10.0.0.3"}), now);
    turns.refused();
    EXPECT_EQ(due(), "10.0.0.2");
    turns.use(addresses({"10.0.0.2", "10.0.0.3", "10.0.0.1"}), now);
    turns.refused();
    EXPECT_EQ(due(), "10.0.0.3");
}

}  // namespace
}  // namespace lightnet::address_turns_test
