#include "core/base/log_bounds.hpp"

#include <gtest/gtest.h>

namespace lightnet::log_bounds_test {
namespace {

using std::chrono::minutes;
using std::chrono::seconds;

const auto start = LogBounds::Time{} + std::chrono::hours(1);

TEST(LogBounds, LetAFewThroughAtOnceAndThenSoManyInAMinute) {
    LogBounds bounds(20);
    int said = 0;
    for (int i = 0; i < 1000; ++i) said += bounds.may_be_said("refuses a", start);
    EXPECT_EQ(said, 20);
    for (int second = 1; second <= 600; ++second)
        for (int i = 0; i < 100; ++i) said += bounds.may_be_said("refuses a", start + seconds(second));
    EXPECT_NEAR(said, 20 + 10 * 20, 2);
}

TEST(LogBounds, OfOneKindLeaveRoomForAnother) {
    LogBounds bounds(2);
    for (int i = 0; i < 10; ++i) bounds.may_be_said("refuses a", start);
    EXPECT_TRUE(bounds.may_be_said("serves a", start));
}

TEST(LogBounds, CountWhatIsLeftOut) {
    LogBounds bounds(20);
    for (int i = 0; i < 532; ++i) bounds.may_be_said("refuses a", start);
    EXPECT_TRUE(bounds.left_out(start + seconds(59)).empty());
    const auto told = bounds.left_out(start + minutes(1));
    ASSERT_EQ(told.size(), 1u);
    EXPECT_EQ(told[0], (std::pair<std::string, std::uint64_t>("refuses a", 512)));
    EXPECT_TRUE(bounds.left_out(start + minutes(3)).empty());
}

TEST(LogBounds, KnowSoManyKindsAndNoMore) {
    LogBounds bounds(1);
    int said = 0;
    for (int kind = 0; kind < 10000; ++kind) said += bounds.may_be_said(std::to_string(kind), start);
    EXPECT_LT(said, 100);
}

TEST(LogBounds, TellKindsByTheFirstTwoWords) {
    EXPECT_EQ(kind_of_line("refuses a run: it is too large"), "refuses a");
    EXPECT_EQ(kind_of_line("begun"), "begun");
    EXPECT_EQ(kind_of_line("two words"), "two words");
    EXPECT_EQ(kind_of_line(""), "");
}

}  // namespace
}  // namespace lightnet::log_bounds_test
