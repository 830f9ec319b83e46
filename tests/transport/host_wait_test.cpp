// How long a run waits for its hosts.
#include "transport/launcher/host_wait.hpp"

#include <gtest/gtest.h>

#include "core/base/error.hpp"

namespace lightnet::host_wait_test {
namespace {

using namespace std::chrono_literals;
using Verdict = HostWait::Verdict;

class HostWaitTest : public ::testing::Test {
protected:
    const HostWait::Time begun{};
    HostPatience patience{5s};
    HostWait wait_for_hosts{patience, begun};
    HostWait::Standing standing;
};

TEST_F(HostWaitTest, BeginsAtOnceWhenAllAreReady) {
    standing.ready = true;
    EXPECT_EQ(wait_for_hosts.look(standing, begun + 1ms), Verdict::begin);
}

TEST_F(HostWaitTest, GivesTheSlowAsLongAgainAsTheFirstTook) {
    standing.pending = true;
    EXPECT_EQ(wait_for_hosts.look(standing, begun + 99s), Verdict::wait);
    standing.ready = true;
    EXPECT_EQ(wait_for_hosts.look(standing, begun + 100s), Verdict::wait);
    EXPECT_EQ(wait_for_hosts.look(standing, begun + 199s), Verdict::wait);
    EXPECT_EQ(wait_for_hosts.look(standing, begun + 201s), Verdict::begin);
}

TEST_F(HostWaitTest, DoesNotWaitForEverForOneThatNeverGetsReady) {
    standing.pending = true;
    EXPECT_EQ(wait_for_hosts.look(standing, begun + 599s), Verdict::wait);
    EXPECT_EQ(wait_for_hosts.look(standing, begun + 601s), Verdict::nobody);
}

TEST_F(HostWaitTest, WaitsAsLongAsFilesArrive) {
    standing.pending = standing.files_arrive = true;
    EXPECT_EQ(wait_for_hosts.look(standing, begun + 1h), Verdict::wait) << "over a slow line that takes its time";
}

TEST_F(HostWaitTest, WaitsForTheAbsentAndTheBusyButNotForLong) {
    standing.ready = standing.absent = true;
    EXPECT_EQ(wait_for_hosts.look(standing, begun + 4s), Verdict::wait);
    EXPECT_EQ(wait_for_hosts.look(standing, begun + 6s), Verdict::begin);
    standing = {};
    standing.busy = true;
    EXPECT_EQ(wait_for_hosts.look(standing, begun + 1h), Verdict::wait) << "when it is the only one there is";
}

TEST_F(HostWaitTest, WaitsForTheBusyNoLongerThanItWasTold) {
    patience.busy = 30s;
    HostWait bounded(patience, begun);
    standing.busy = true;
    EXPECT_EQ(bounded.look(standing, begun + 29s), Verdict::wait);
    EXPECT_EQ(bounded.look(standing, begun + 30s), Verdict::nobody_free);
}

TEST_F(HostWaitTest, WaitsForNobodyWhenTheTimeIsOver) {
    patience.most = 3s;
    HostWait bounded(patience, begun);
    for (bool HostWait::Standing::*const which : {&HostWait::Standing::busy, &HostWait::Standing::pending,
                                                  &HostWait::Standing::others_may_come, &HostWait::Standing::absent}) {
        HostWait::Standing one;
        one.*which = true;
        EXPECT_EQ(bounded.look(one, begun + 2s), Verdict::wait);
        EXPECT_EQ(bounded.look(one, begun + 3s), one.busy ? Verdict::nobody_free : Verdict::nobody);
        one.ready = true;
        EXPECT_EQ(bounded.look(one, begun + 3s), Verdict::begin);
    }
}

TEST_F(HostWaitTest, GivesUpWhenNobodyIsThereAndNobodyMayCome) {
    EXPECT_EQ(wait_for_hosts.look(standing, begun + 1s), Verdict::nobody);
    standing.others_may_come = true;
    EXPECT_EQ(wait_for_hosts.look(standing, begun + 4s), Verdict::wait);
    EXPECT_EQ(wait_for_hosts.look(standing, begun + 5s), Verdict::nobody);
}

TEST_F(HostWaitTest, SpeaksEveryFewSecondsAndThenLessOften) {
    int words = 0;
    for (auto second = 0s; second < 20s; second += 1s) words += wait_for_hosts.should_speak(begun + second);
    EXPECT_GE(words, 4);
    for (auto second = 20s; second < 3600s; second += 1s) words += wait_for_hosts.should_speak(begun + second);
    EXPECT_LT(words, 100);
}

class ExpectedHostsTest : public ::testing::Test {
protected:
    ExpectedHostsTest() { hosts.begin(HostPatience{5s}, begun); }
    const ExpectedHosts::Time begun{};
    ExpectedHosts hosts;
    HostWait::Standing standing;
};

TEST_F(ExpectedHostsTest, MayComeWhileTheyBuildOrHaveNotAnsweredForLong) {
    EXPECT_FALSE(hosts.may_come(standing, begun));
    standing.pending = true;
    EXPECT_TRUE(hosts.may_come(standing, begun + 1h));
    standing.pending = false, standing.absent = true;
    EXPECT_TRUE(hosts.may_come(standing, begun + 9s));
    EXPECT_FALSE(hosts.may_come(standing, begun + 10s));
}

TEST_F(ExpectedHostsTest, EndTheRunWithTheLastOnesReasonWhenNoneComes) {
    standing.absent = true;
    hosts.wait_for_others("there is not enough memory");
    EXPECT_NO_THROW(hosts.look(standing, begun + 9s));
    EXPECT_THROW(hosts.look(standing, begun + 10s), Error);
}

TEST_F(ExpectedHostsTest, AreNoMoreWaitedForWhenOneIsReady) {
    hosts.wait_for_others("there is not enough memory");
    standing.ready = true;
    hosts.look(standing, begun + 1h);
    standing.ready = false;
    EXPECT_NO_THROW(hosts.look(standing, begun + 2h)) << "its loss is another matter";
}

}  // namespace
}  // namespace lightnet::host_wait_test
