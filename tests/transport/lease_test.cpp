// Silence that counts as loss.
#include "transport/wire/lease.hpp"

#include <gtest/gtest.h>

namespace lightnet::lease_test {
namespace {

using namespace std::chrono_literals;

struct LeaseTest : ::testing::Test {
    Lease lease{400ms, 1500ms, 10s};
    Lease::Time now = Lease::Time{} + 1h;

    LeaseTest() { lease.begin(now); }
    void hear_after(std::chrono::milliseconds time) { lease.heard(now += time); }
};

TEST_F(LeaseTest, IsShortForWhoIsHeardInTime) {
    for (int i = 0; i < 100; ++i) hear_after(400ms);
    EXPECT_FALSE(lease.is_over(now + 1500ms));
    EXPECT_TRUE(lease.is_over(now + 1501ms));
}

TEST_F(LeaseTest, GrowsForWhoIsLate) {
    hear_after(900ms);
    EXPECT_EQ(lease.length(), 3500ms);
    hear_after(1400ms);
    EXPECT_EQ(lease.length(), 5500ms);
}

TEST_F(LeaseTest, HasAnEndHoweverLateHeWas) {
    hear_after(60s);
    EXPECT_EQ(lease.length(), 10s);
}

TEST_F(LeaseTest, KeepsInMindHowLateHeWasForAWhile) {
    hear_after(900ms);
    for (int i = 0; i < 70; ++i) hear_after(400ms);
    EXPECT_EQ(lease.length(), 3500ms);
    for (int i = 0; i < 10; ++i) hear_after(400ms);
    EXPECT_EQ(lease.length(), 1500ms);
}

TEST_F(LeaseTest, KnowsNothingOfTheTimeBeforeItBegan) {
    hear_after(900ms);
    lease.begin(now += 1h);
    EXPECT_EQ(lease.length(), 1500ms);
    EXPECT_FALSE(lease.is_over(now));
}

TEST_F(LeaseTest, GivesALineTheTimeThatItIsBusy) {
    EXPECT_FALSE(lease.is_over(now + 3s, 2s));
    EXPECT_TRUE(lease.is_over(now + 4s, 2s));
}

}  // namespace
}  // namespace lightnet::lease_test
