// How many samples there is time for.
#include "tools/support/time_limit.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace lightnet::time_limit_test {
namespace {

using namespace std::chrono_literals;

const TimeLimit::Time begun{};

TEST(TimeLimit, IsNoneWhereNobodySetsOne) {
    const TimeLimit none;
    EXPECT_FALSE(none);
    EXPECT_FALSE(none.over(begun + 1000h));
    EXPECT_EQ(none.next(0, 64, begun), 64u) << "all at once";
    EXPECT_EQ(none.next(64, 64, begun), 0u);
}

TEST(TimeLimit, BeginsWithASampleThatShowsHowLongOthersTake) {
    const TimeLimit limit(10s, begun);
    EXPECT_EQ(limit.next(0, 64, begun), 1u);
    EXPECT_EQ(limit.next(32, 64, begun), 33u) << "a run that goes on knows no more";
    EXPECT_EQ(limit.next(0, 64, begun + 10s), 0u);
    EXPECT_TRUE(limit.over(begun + 10s));
}

TEST(TimeLimit, TakesAsManyAsFitAndNoMore) {
    TimeLimit limit(100s, begun);
    limit.took(1, 10s);
    EXPECT_EQ(limit.next(1, 64, begun + 10s), 8u) << "nine tenths of what is left";
    EXPECT_EQ(limit.next(8, 64, begun + 90s), 0u) << "one would be fewer than there are";
    EXPECT_EQ(limit.next(1, 4, begun + 10s), 4u) << "no more are wanted";
}

TEST(TimeLimit, GoesByBlocksWhileTheyFitAndMoreOfThemTheMoreTimeThereIs) {
    TimeLimit limit(1000s, begun);
    limit.took(1, 1s);
    EXPECT_EQ(limit.next(1, 100000, begun + 1s), 16u) << "little is known";
    limit.took(16, 16s);
    EXPECT_EQ(limit.next(16, 100000, begun + 17s), 16u + 4 * 16);
    limit.took(64, 64s);
    EXPECT_EQ(limit.next(80, 100000, begun + 81s), 256u) << "a fourth of what fits, to the end of a group";
    EXPECT_EQ(limit.next(128, 100000, begun + 900s), 128u + 16) << "a fourth of 90";
    EXPECT_EQ(limit.next(144, 100000, begun + 980s), 144u + 16) << "18 fit";
    EXPECT_EQ(limit.next(160, 100000, begun + 990s), 160u + 9) << "a short last block";
    EXPECT_EQ(limit.next(169, 100000, begun + 999s), 0u);
    EXPECT_EQ(limit.next(64, 72, begun), 72u);
}

// Whatever samples cost, nothing is begun for which there is no time, and little of it is left over.
TEST(TimeLimit, UsesMostOfTheTime) {
    for (const double cost : {3e-6, 1e-3, 0.4, 1.0, 3.0, 7.0, 20.0, 40.0}) {
        const double all = 100;
        TimeLimit limit(std::chrono::duration<double>(all), begun);
        double spent = 0;
        std::uint32_t there = 0;
        int steps = 0;
        const auto now = [&] {
            return begun + std::chrono::ceil<Pace::Clock::duration>(std::chrono::duration<double>(spent));
        };
        while (const auto next = limit.next(there, 1'000'000'000, now())) {
            const auto adds = next - there / 16 * 16;
            spent += cost * adds;
            limit.took(adds, std::chrono::duration<double>(cost * adds));
            ASSERT_GT(next, there);
            there = next;
            ++steps;
        }
        EXPECT_LE(spent, all) << cost;
        EXPECT_GE(spent, all * 0.7 - cost) << cost;
        EXPECT_LT(steps, 100) << cost;
    }
}

}  // namespace
}  // namespace lightnet::time_limit_test
