// What the benchmarks' judgements let pass, and what not.
#include "tests/bench/judge.hpp"

#include <gtest/gtest.h>

namespace lightnet::bench {
namespace {

TEST(OneTestPassed, WantsATestThatRan) {
    const std::string ran = "[==========] 1 test from 1 test suite ran. (7 ms total)\n";
    EXPECT_TRUE(one_test_passed(ran + "[  PASSED  ] 1 test.\n"));
    EXPECT_FALSE(one_test_passed("[==========] 0 tests from 0 test suites ran. (0 ms total)\n[  PASSED  ] 0 tests.\n"));
    EXPECT_FALSE(one_test_passed(ran + "[  PASSED  ] 0 tests.\n[  SKIPPED ] 1 test, listed below:\n"));
    EXPECT_FALSE(one_test_passed(ran + "[  FAILED  ] 1 test, listed below:\n"));
    EXPECT_FALSE(one_test_passed(""));
}

constexpr double mib = 1 << 20;

// A minute of a process of 100 MiB that saves something large every five seconds.
std::vector<MemorySample> a_minute(double leak_per_second) {
    std::vector<MemorySample> samples;
    for (double t = 0; t < 60; t += 0.5) {
        const double wobble = mib * 0.3 * (static_cast<int>(t * 7) % 3),
                     saving = static_cast<int>(t) % 5 == 2 ? 12 * mib : 0;
        samples.push_back({t, 100 * mib + wobble + saving + leak_per_second * t});
    }
    return samples;
}

TEST(Growth, OfWhatTakesRoomForAMomentIsNone) { EXPECT_NEAR(growth(a_minute(0)), 0, 0.005 * mib); }

TEST(Growth, OfALeakOfSomeMegabytesAMinuteIsSeen) {
    for (const double per_minute : {2.0, 5.0, 60.0})
        EXPECT_NEAR(growth(a_minute(per_minute * mib / 60)) * 60 / mib, per_minute, 0.4);
}

TEST(Growth, OfNothingSeenIsNone) { EXPECT_EQ(growth({}), 0); }

TEST(RankCorrelation, IsOneInTheSameOrderAndLessInAnyOther) {
    EXPECT_NEAR(rank_correlation({1, 2, 3, 4}, {10, 20, 21, 1000}), 1, 1e-12);
    EXPECT_NEAR(rank_correlation({1, 2, 3, 4}, {4, 3, 2, 1}), -1, 1e-12);
    EXPECT_NEAR(rank_correlation({1, 2, 3, 4}, {1, 2, 4, 3}), 0.8, 1e-12);
    EXPECT_EQ(rank_correlation({1, 2, 3, 4}, {7, 7, 7, 7}), 0);
}

TEST(PartBelow, IsTheValueThatSoManyAreNotAbove) {
    EXPECT_EQ(part_below({10, 9, 8, 7, 6, 5, 4, 3, 2, 1}, 0.9), 9);
    EXPECT_EQ(part_below({3}, 0.9), 3);
}

}  // namespace
}  // namespace lightnet::bench
