// Looks before sleeping, counted on a clock that only goes on when it is looked at.
#include "transport/lines/look_first.hpp"

#include <gtest/gtest.h>

#include <chrono>

namespace lightnet::look_first_test {
namespace {

using namespace std::chrono_literals;

class LookFirstTest : public ::testing::Test {
protected:
    /// What comes is found at the look of this number, counted from 1; 0: never.
    bool wait(int comes_at = 0) {
        looks = 0;
        return first.look([&] { return ++looks == comes_at; });
    }
    int looks_of(int waits) {
        int all = 0;
        for (int i = 0; i < waits; ++i) wait(), all += looks;
        return all;
    }

    AwakeThreads awake{2};
    LookFirst::Time now{1h};
    std::chrono::nanoseconds step = 1us;  // of each look at the clock
    int looks = 0;
    LookFirst first{awake, [this] { return now += step; }};
};

TEST_F(LookFirstTest, FindsWhatComesSoon) {
    awake.come(2);
    EXPECT_TRUE(wait(5));
    EXPECT_EQ(looks, 5);
}

TEST_F(LookFirstTest, EndsAfterTwentyMicroseconds) {
    awake.come(1);
    EXPECT_FALSE(wait());
    EXPECT_EQ(looks, 20);
}

TEST_F(LookFirstTest, IsLeftOutWhereThereAreAsManyOthersAwakeAsProcessors) {
    awake.come(3);
    EXPECT_FALSE(wait(1));
    EXPECT_EQ(looks, 0);
    awake.go();
    EXPECT_TRUE(wait(1));
}

TEST_F(LookFirstTest, EndsWhenAnotherThreadWakesUp) {
    awake.come(2);
    EXPECT_FALSE(first.look([&] {
        if (++looks == 4) awake.come();
        return false;
    }));
    EXPECT_EQ(looks, 4);
}

TEST_F(LookFirstTest, IsLeftOutForAWhileOnABusyMachine) {
    awake.come(1);
    step = 1ms;  // it stood still for so long
    EXPECT_FALSE(wait());
    EXPECT_EQ(looks, 1);
    step = 1us;
    EXPECT_EQ(looks_of(1000), 0);
    now += 100ms;
    EXPECT_TRUE(wait(1));
}

TEST_F(LookFirstTest, IsRarerWhereNothingComes) {
    awake.come(1);
    EXPECT_EQ(looks_of(1 + 2 + 4 + 8 + 16 + 32), 6 * 20);
    EXPECT_EQ(looks_of(640), 10 * 20) << "one wait in sixty-four";
    while (!wait(3)) {
    }
    EXPECT_TRUE(wait(3)) << "what came once may come again";
}

}  // namespace
}  // namespace lightnet::look_first_test
