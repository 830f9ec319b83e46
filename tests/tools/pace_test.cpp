#include "tools/support/pace.hpp"

#include <gtest/gtest.h>

namespace lightnet::pace_test {
namespace {

using namespace std::chrono_literals;

const Pace::Clock::time_point start{};

TEST(Pace, IsDueOnceEveryPeriod) {
    Pace pace(2s, start);
    EXPECT_FALSE(pace.due(start + 1999ms));
    EXPECT_TRUE(pace.due(start + 2s));
    pace.put_off(start + 3s);
    EXPECT_FALSE(pace.due(start + 4s));
    EXPECT_TRUE(pace.due(start + 5s));
}

TEST(Pace, IsNeverDueWhereItsPeriodIsLongerThanAClockCounts) {
    Pace pace(std::chrono::duration<double>(1e300), start);
    EXPECT_FALSE(pace.due(start + 24h));
    pace.put_off(start + 24h, std::chrono::duration<double>(1e300));
    EXPECT_FALSE(pace.due(start + 48h));
}

TEST(Pace, LeavesTimeForOtherThings) {
    Pace pace(2s, start);
    pace.put_off(start, 9s);
    EXPECT_FALSE(pace.due(start + 8s));
    EXPECT_TRUE(pace.due(start + 9s));
    pace.put_off(start, 1s);
    EXPECT_FALSE(pace.due(start + 1s)) << "no pause is shorter than the period";
    EXPECT_TRUE(pace.due(start + 2s));
}

}  // namespace
}  // namespace lightnet::pace_test
