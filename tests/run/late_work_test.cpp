// What a scheduler does about work that is late, or seems to be lost.
#include <gtest/gtest.h>

#include "tests/run/scheduler_story.hpp"

namespace lightnet::late_work_test {

class LateWork : public test::SchedulerStory {
protected:
    void use(Scheduler::Rules rules) { scheduler = Scheduler(rules); }
    void join(Scheduler::Replica replica, Credit credit = {1, 1000, 1 << 20}) {
        tell(Scheduler::Joined{replica, replica, replica + 1, credit});
    }
    void add(Scheduler::WorkId work) { tell(Scheduler::Added{work}); }
};

TEST_F(LateWork, AsksElsewhereWhatIsOverdueAndTakesTheFirstAnswer) {
    join(0), join(1);
    add(1), add(2);
    tick();
    now = 1, reply(2, 1);
    now = 100;  // 0 hangs
    EXPECT_EQ(tick(), (Replicas{1}));
    reply(1, 1);
    EXPECT_TRUE(did<Scheduler::Accept>());
    reply(1, 0);
    EXPECT_TRUE(did<Scheduler::Drop>());
    EXPECT_EQ(scheduler.in_flight().copies(), 0u);
}

TEST_F(LateWork, TakesTheAnswerOfAHangingReplicaWhenItIsTheFirstAfterAll) {
    join(0);
    add(1);
    tick();
    now = 100;
    EXPECT_EQ(tick(), (Replicas{0})) << "nobody else is there";
    const auto second = copies.at({1, 0});
    tell(Scheduler::Replied{second - 1});
    EXPECT_TRUE(did<Scheduler::Accept>());
}

TEST_F(LateWork, AsksASilentReplicaMoreAndMoreRarely) {
    join(0, {4, 1000, 1000});
    add(1);
    tick();
    int asked = 0;
    for (; now < 10000; now += 1) asked += static_cast<int>(tick().size());
    EXPECT_GT(asked, 3);
    EXPECT_LT(asked, 15);
}

TEST_F(LateWork, AsksNobodyWhoIsBusyWhatIsOverdueElsewhere) {
    join(0), join(1);
    add(1), add(2);
    tick();
    now = 1, reply(2, 1);
    now = 2, add(3);
    EXPECT_EQ(tick(), (Replicas{1}));
    now = 100, tell(Scheduler::Alive{1});
    EXPECT_TRUE(tick().empty()) << "0 hangs, but 1 is at work";
    reply(3, 1);
    EXPECT_EQ(tick(), (Replicas{1}));
}

TEST_F(LateWork, WaitsForWhoShowsThatHeWorksHoweverLongItTakes) {
    join(0), join(1);
    add(1), add(2);
    tick();
    now = 1, reply(2, 1);
    for (; now < 1000; now += 1) {
        tell(Scheduler::Alive{0});
        ASSERT_TRUE(tick().empty()) << "after " << now << " s";
    }
    for (; now < 1100; now += 1)
        if (!tick().empty()) break;
    EXPECT_LT(now, 1035) << "it has stopped working";
    EXPECT_EQ(scheduler.counts().written_off, 1u);
}

TEST_F(LateWork, DoesNothingTwiceWithinTheProcess) {
    Scheduler::Rules rules;
    rules.double_tail = true;
    use(rules);
    for (const Scheduler::Replica replica : {0, 1})
        tell(Scheduler::Joined{
            .replica = replica, .host = 0, .name = replica, .credit = {2, 1000, 1000}, .within_process = true});
    add(1), add(2);
    tick();
    now = 1, reply(1, 0, 1), reply(2, 1, 1);
    add(3);
    tick();
    for (; now < 1000; now += 1) ASSERT_TRUE(tick().empty()) << "after " << now << " s";
    EXPECT_EQ(scheduler.counts(), Scheduler::Counts{});
}

TEST_F(LateWork, LetsOtherHostsDoOnceMoreWhatComesLastWithinTheProcess) {
    Scheduler::Rules rules;
    rules.double_tail = true;
    use(rules);
    tell(Scheduler::Joined{.replica = 0, .host = 0, .name = 1, .credit = {1, 1000, 1000}, .within_process = true});
    tell(Scheduler::Joined{.replica = 1, .host = 0, .name = 2, .credit = {1, 1000, 1000}, .within_process = true});
    tell(Scheduler::Joined{.replica = 2, .host = 1, .name = 3, .credit = {1, 1000, 1000}});
    add(1), add(2), add(3);
    tick();
    now = 1, reply(1, 0, 1), reply(2, 1, 1), reply(3, 2, 1);
    add(4);
    EXPECT_EQ(tick(), (Replicas{0}));
    now = 5;
    EXPECT_EQ(tick(), (Replicas{2}));
}

TEST_F(LateWork, TakesNoPieceForLateThatMayBeAsDearAsOthersWere) {
    Scheduler::Rules rules;
    rules.double_tail = true;
    use(rules);
    join(0), join(1);
    const auto round = [&](Scheduler::WorkId work, double seconds) {
        add(work), add(work + 1);
        tick();
        now += seconds, reply(work, 0), reply(work + 1, 1);
    };
    for (Scheduler::WorkId work = 10; work < 30; work += 2) round(work, work % 4 ? 0.1 : 1);
    add(1), add(2);
    tick();
    now += 0.1, reply(1, 0);
    now += 0.8;
    EXPECT_TRUE(tick().empty()) << "every other piece took a second";
    now += 30;
    EXPECT_EQ(tick(), (Replicas{0}));
}

TEST_F(LateWork, LetsIdleReplicasDoTheTailOnceMore) {
    Scheduler::Rules rules;
    rules.double_tail = true;
    use(rules);
    join(0), join(1);
    add(1), add(2);
    tick();
    now = 1, reply(1, 0, 1), reply(2, 1, 1);
    add(3), add(4);
    tick();
    now = 2, reply(3, 0, 1);
    now = 3;  // what 1 has is late by its whole time
    EXPECT_TRUE(tick().empty()) << "of so little work, what saves no second is not done twice";
    EXPECT_EQ(scheduler.next_tick(), 4);
    now = 4;
    EXPECT_EQ(tick(), (Replicas{0}));
    EXPECT_EQ(scheduler.counts().doubled, 1u);
    tell(Scheduler::Foreseen{5});
    EXPECT_TRUE(tick().empty());
}

}  // namespace lightnet::late_work_test
