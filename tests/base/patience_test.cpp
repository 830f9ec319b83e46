#include "core/base/patience.hpp"

#include <gtest/gtest.h>

namespace lightnet::patience_test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(Patience, IsOverWhenSomebodyHasLookedForSoLong) {
    const Patience::Clock::time_point begun{};
    Patience patience(seconds(2), begun);
    auto now = begun;
    for (int looks = 0; looks < 7; ++looks) EXPECT_FALSE(patience.is_over(now += Patience::between_looks)) << looks;
    EXPECT_TRUE(patience.is_over(now += Patience::between_looks));
    EXPECT_EQ(patience.until_look(), milliseconds(0));
}

TEST(Patience, CountsLittleWhileNobodyCouldLook) {
    const Patience::Clock::time_point begun{};
    Patience patience(seconds(2), begun);
    EXPECT_FALSE(patience.is_over(begun + seconds(600)));
    EXPECT_EQ(patience.until_look(), Patience::between_looks);
    EXPECT_TRUE(patience.is_over(begun + seconds(601)));
}

TEST(Patience, OfNothingIsOver) { EXPECT_TRUE(Patience(seconds(0)).is_over()); }

}  // namespace
}  // namespace lightnet::patience_test
