#include "core/run/schedule/scheduler.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "tests/run/scheduler_story.hpp"

namespace lightnet::scheduler_test {
namespace {

class SchedulerTest : public test::SchedulerStory {
protected:
    void use(Scheduler::Rules rules) { scheduler = Scheduler(rules); }
    void join(Scheduler::Replica replica, Credit credit = {1, 1000, 1 << 20}) { join_on(replica, replica, credit); }
    void join_on(Scheduler::Host host, Scheduler::Replica replica, Credit credit = {1, 1000, 1 << 20},
                 std::uint64_t process = 0) {
        tell(Scheduler::Joined{replica, host, replica + 1, credit, process});
    }
    void add(Scheduler::WorkId work, std::size_t bytes = 0, std::uint64_t region = 0) {
        tell(Scheduler::Added{work, 1, bytes, region});
    }
};

// Work that waited for the reserve, as that would be done sooner, would be sent to nobody.
TEST_F(SchedulerTest, HoldsNothingBackForTheReserveHoweverFastThatIs) {
    join(0);
    tell(Scheduler::Joined{1, 1, 2, {1, 1000, 1 << 20}, 0, 1, true});
    add(1), add(2);
    EXPECT_EQ(tick(), (Replicas{0, 1})) << "the reserve, when no other is free";
    now = 1;
    reply(2, 1, 0.001), reply(1, 0, 1);
    add(3);
    EXPECT_EQ(tick(), (Replicas{0}));
}

TEST_F(SchedulerTest, GivesCreditBackWithTheReply) {
    join(0);
    add(1), add(2);
    EXPECT_EQ(tick(), (Replicas{0}));
    EXPECT_FALSE(scheduler.has_room());
    reply(1, 0);
    EXPECT_TRUE(did<Scheduler::Accept>());
    EXPECT_EQ(tick(), (Replicas{0}));
}

TEST_F(SchedulerTest, CountsCreditInBytesToo) {
    join(0, {8, 1000, 100});
    add(1, 60), add(2, 60), add(3, 60);
    EXPECT_EQ(tick().size(), 2u) << "the second begins below the limit, the third does not";
}

TEST_F(SchedulerTest, ExpectsCompletionFromOutstandingWorkFillLevelAndServiceTime) {
    join(0, {8, 1000, 1000});
    add(1);
    tick();
    reply(1, 0, 2e-6, 5);
    EXPECT_NEAR(scheduler.order().completion_time(0, 10), (5 + 10) * 2e-6, 1e-12);
}

// Beside work of a thousand questions, a tenth of the time would outweigh all that lies before the faster one.
TEST_F(SchedulerTest, ComparesReplicasByWorkOfTheSizeThatComes) {
    join(0, {64, 100'000, 1 << 20}), join(1, {64, 100'000, 1 << 20});
    Scheduler::WorkId work = 0;
    const auto answered = [&](std::size_t questions) {
        tell(Scheduler::Added{++work, questions, 0, 0});
        for (const auto replica : tick()) {
            const double each = replica == 0 ? 1.0e-3 : 1.1e-3;
            now += each * double(questions);
            reply(work, replica, each);
        }
    };
    for (int i = 0; i < 8; ++i) answered(1000);
    for (int i = 0; i < 200; ++i) answered(10);
    for (int i = 0; i < 40; ++i) tell(Scheduler::Added{++work, 10, 0, 0});
    const auto sent = tick();
    const auto first_eight = std::count(sent.begin(), sent.begin() + 8, Scheduler::Replica{1});
    EXPECT_GE(first_eight, 3) << "they share them from the first on";
}

TEST_F(SchedulerTest, TrustsItsOwnClockMoreThanAnAnswererThatWaitsForOthers) {
    join(0);
    add(1);
    tick();
    now = 3;  // though the answerer says that it took a microsecond
    reply(1, 0, 1e-6);
    EXPECT_NEAR(scheduler.order().completion_time(0, 1), 3, 1e-9);
}

TEST_F(SchedulerTest, DropsLateAndDoubledReplies) {
    join(0);
    add(1);
    tick();
    reply(1, 0);
    reply(1, 0);
    EXPECT_TRUE(did<Scheduler::Drop>());
}

TEST_F(SchedulerTest, HoldsTheLastWorkBackFromAReplicaThatIsTooSlowForIt) {
    join(0), join(1);
    add(1), add(2);
    tick();
    now = 1, reply(1, 0);
    now = 10, reply(2, 1);
    add(3), add(4);
    EXPECT_EQ(tick(), (Replicas{0})) << "the fast one will have done both before the slow one has one";
    now = 11, reply(3, 0);
    EXPECT_EQ(tick(), (Replicas{0}));
}

TEST_F(SchedulerTest, RunsSuspectsAloneAndConvictsAfterThreeDeathsAlone) {
    join(0, {2, 1000, 1000});
    add(1), add(2);
    EXPECT_EQ(tick().size(), 2u);
    tell(Scheduler::Gone{{0}, true});
    EXPECT_FALSE(did<Scheduler::SetAside>());
    std::set<Scheduler::WorkId> alone;
    for (int death = 0; death < 6; ++death) {
        join(0, {2, 1000, 1000});
        EXPECT_EQ(tick().size(), 1u) << "one suspect at a time";
        alone.insert(std::get<Scheduler::Send>(actions.front()).work);
        tell(Scheduler::Gone{{0}, true});
        EXPECT_EQ(did<Scheduler::SetAside>(), death >= 4) << death;
    }
    EXPECT_EQ(alone, (std::set<Scheduler::WorkId>{1, 2}));
    EXPECT_EQ(scheduler.backlog().size(), 0u);
}

TEST_F(SchedulerTest, BlamesNobodyForAHostThatComesBackAsTheSameProcess) {
    join_on(0, 0, {2, 1000, 1000}, 5);
    add(1), add(2);
    for (int cut = 0; cut < 10; ++cut) {
        EXPECT_EQ(tick().size(), 2u) << "nothing is suspect";
        tell(Scheduler::Gone{{0}, true});
        join_on(0, 0, {2, 1000, 1000}, 5);
    }
    EXPECT_FALSE(did<Scheduler::SetAside>());
}

TEST_F(SchedulerTest, StillBlamesWorkForTheDeathsOfOtherProcesses) {
    join_on(0, 0, {2, 1000, 1000}, 5);
    add(1);
    for (std::uint64_t process = 6; process < 9; ++process) {
        EXPECT_EQ(tick().size(), 1u);
        tell(Scheduler::Gone{{0}, true});
        EXPECT_EQ(did<Scheduler::SetAside>(), process == 8);
        join_on(0, 0, {2, 1000, 1000}, process);
    }
}

TEST_F(SchedulerTest, CountsNoDeathAgainstWorkThatSharedItsHost) {
    join_on(7, 0), join_on(7, 1);
    for (int death = 0; death < 5; ++death) {
        if (death == 0) add(1), add(2);
        if (death > 0) break;
        EXPECT_EQ(tick().size(), 2u);
        tell(Scheduler::Gone{{0, 1}, true});
    }
    join_on(7, 0), join_on(7, 1);
    EXPECT_EQ(tick().size(), 1u) << "places of one host die together, so suspects have the whole host";
}

TEST_F(SchedulerTest, BlamesNoWorkOfAReplicaThatLeftInGoodOrder) {
    join(0, {2, 1000, 1000});
    add(1), add(2);
    tick();
    tell(Scheduler::Gone{{0}, false});
    join(1, {2, 1000, 1000});
    EXPECT_EQ(tick(), (Replicas{1, 1}));
}

TEST_F(SchedulerTest, FreesASuspectThatIsAnswered) {
    join(0, {2, 1000, 1000});
    add(1);
    tick();
    tell(Scheduler::Gone{{0}, true});
    join(1, {2, 1000, 1000});
    add(2);
    EXPECT_EQ(tick(), (Replicas{1}));
    EXPECT_EQ(copies.count({1, 1}), 1u) << "the suspect, alone";
    reply(1, 1);
    EXPECT_EQ(tick(), (Replicas{1}));
}

TEST_F(SchedulerTest, WaitsForNoHostThatDrainsBeforeItTestsASuspect) {
    join(0), join(1, {2, 1000, 1000});
    add(1), add(2);
    EXPECT_EQ(tick(), (Replicas{0, 1}));
    tell(Scheduler::Gone{{0}, true});
    EXPECT_EQ(tick(), Replicas{}) << "the other host is to be empty first";
    join(2);
    tell(Scheduler::Draining{1, true});
    EXPECT_EQ(tick(), (Replicas{2}));
    EXPECT_EQ(copies.count({1, 2}), 1u);
    reply(2, 1);
    EXPECT_EQ(tick(), Replicas{});
    reply(1, 2);
    EXPECT_EQ(scheduler.backlog().size(), 0u);
}

TEST_F(SchedulerTest, SendsARegionHomeUnlessHomeIsOverloaded) {
    Scheduler::Rules rules;
    rules.strategy = Strategy::affinity;
    use(rules);
    for (Scheduler::Replica replica = 0; replica < 4; ++replica) join(replica, {100, 1000, 1000});
    const auto home = scheduler.replicas().home(42);
    for (Scheduler::WorkId work = 1; work <= 3; ++work) add(work, 0, 42);
    EXPECT_EQ(tick(), (Replicas{home, home, home}));
    for (Scheduler::WorkId work = 4; work <= 20; ++work) add(work, 0, 42);
    tick();
    EXPECT_GT(scheduler.counts().spilled, 0u);
}

TEST_F(SchedulerTest, MovesOnlyTheRegionsOfAReplicaThatGoes) {
    Scheduler::Rules rules;
    rules.strategy = Strategy::affinity;
    use(rules);
    for (Scheduler::Replica replica = 0; replica < 8; ++replica) join(replica);
    std::map<std::uint64_t, Scheduler::Replica> before;
    for (std::uint64_t region = 0; region < 1000; ++region) before[region] = scheduler.replicas().home(region);
    tell(Scheduler::Gone{{3}, true});
    for (const auto& [region, home] : before)
        EXPECT_TRUE(home == 3 || scheduler.replicas().home(region) == home) << region;
    join(3);
    for (const auto& [region, home] : before)
        EXPECT_EQ(scheduler.replicas().home(region), home) << "and they come back with it";
}

// ---- failures ----

TEST_F(SchedulerTest, AsksAnotherHostWhatFailedAtOne) {
    join_on(0, 0), join_on(0, 1), join_on(1, 2);
    add(1);
    const auto first = tick();
    ASSERT_EQ(first.size(), 1u);
    tell(Scheduler::Failed{copies.at({1, first[0]})});
    EXPECT_TRUE(did<Scheduler::Retry>());
    const auto second = tick();
    ASSERT_EQ(second.size(), 1u);
    EXPECT_NE(first[0] < 2, second[0] < 2) << "places of one host fail alike";
    reply(1, second[0]);
    EXPECT_TRUE(did<Scheduler::Accept>());
    EXPECT_EQ(scheduler.counts().retried, 1u);
}

TEST_F(SchedulerTest, GivesUpWhatFailsAtASecondHost) {
    join(0), join(1), join(2);
    add(1);
    const auto first = tick();
    tell(Scheduler::Failed{copies.at({1, first[0]})});
    const auto second = tick();
    tell(Scheduler::Failed{copies.at({1, second[0]})});
    EXPECT_TRUE(did<Scheduler::GiveUp>());
    EXPECT_EQ(scheduler.backlog().size(), 0u);
    EXPECT_TRUE(tick().empty());
}

TEST_F(SchedulerTest, GivesUpAtOnceWhatFailsAtTheOnlyHost) {
    join_on(0, 0), join_on(0, 1);
    add(1);
    const auto first = tick();
    tell(Scheduler::Failed{copies.at({1, first[0]})});
    EXPECT_TRUE(did<Scheduler::GiveUp>());
}

TEST_F(SchedulerTest, KeepsWhatFailsAtTheOnlyHostForOneThatIsExpected) {
    tell(Scheduler::HostsExpected{true});
    join(0);
    add(1);
    tick();
    tell(Scheduler::Failed{copies.at({1, 0})});
    EXPECT_TRUE(did<Scheduler::Retry>());
    EXPECT_TRUE(tick().empty()) << "the one that failed is not asked again";
    join(1);
    EXPECT_EQ(tick(), (Replicas{1}));
    reply(1, 1);
    EXPECT_TRUE(did<Scheduler::Accept>());
}

TEST_F(SchedulerTest, GivesUpWhatFailedWhenTheHostThatWasExpectedDoesNotCome) {
    tell(Scheduler::HostsExpected{true});
    join(0);
    add(1);
    tick();
    tell(Scheduler::Failed{copies.at({1, 0})});
    EXPECT_FALSE(did<Scheduler::GiveUp>());
    tell(Scheduler::HostsExpected{false});
    tick();
    EXPECT_TRUE(did<Scheduler::GiveUp>());
}

TEST_F(SchedulerTest, GivesUpWhatFailedWhenTheOtherHostsAreLostMeanwhile) {
    join(0), join(1);
    add(1), add(2);
    EXPECT_EQ(tick().size(), 2u);
    const auto at = copies.contains({1, 0}) ? 0u : 1u;
    tell(Scheduler::Failed{copies.at({1, at})});
    EXPECT_TRUE(did<Scheduler::Retry>());
    EXPECT_TRUE(tick().empty()) << "the other one is busy";
    tell(Scheduler::Gone{{1 - at}, false});
    tick();
    bool gave_up = false;
    for (const auto& action : actions) gave_up |= action == Scheduler::Action{Scheduler::GiveUp{1}};
    EXPECT_TRUE(gave_up) << "rather than wait for ever";
}

TEST_F(SchedulerTest, DropsALateFailure) {
    join(0), join(1);
    add(1);
    const auto first = tick();
    now = 1000;
    const auto second = tick();
    ASSERT_EQ(second.size(), 1u);
    reply(1, second[0]);
    tell(Scheduler::Failed{copies.at({1, first[0]})});
    EXPECT_TRUE(did<Scheduler::Drop>());
}

}  // namespace
}  // namespace lightnet::scheduler_test
