// A scheduler whose replicas are hosts with several places each.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/run/scheduler_story.hpp"

namespace lightnet::scheduler_hosts_test {
namespace {

class SchedulerOfHosts : public test::SchedulerStory {
protected:
    void join(const Scheduler::Joined& host) { tell(host); }
    void add(Scheduler::WorkId work) { tell(Scheduler::Added{work}); }
};

TEST_F(SchedulerOfHosts, ExpectsOfAHostThatItsPlacesShareWhatIsAheadAndOneDoesTheNewWork) {
    join({0, 0, 1, {8, 1000, 1000}, 0, 4});
    add(1);
    tick();
    reply(1, 0, 1.0, 12);
    EXPECT_EQ(scheduler.replicas().places(), 4u);
    EXPECT_NEAR(scheduler.order().completion_time(0, 2), 12 / 4 + 2, 1e-12);
    EXPECT_NEAR(scheduler.order().times().mean(), 1, 1e-12);
}

TEST_F(SchedulerOfHosts, MeasuresAPlaceOfAHostHoweverManyWorkAtOnce) {
    for (const std::uint32_t places : {1u, 4u}) {
        scheduler = Scheduler({});
        now = 0;
        join({0, 0, 1, {8, 1000, 1000}, 0, places});
        for (Scheduler::WorkId work = 1; work <= 4; ++work) add(work);
        tick();
        for (Scheduler::WorkId work = 1; work <= 4; ++work) {
            now = places == 1 ? double(work) : 1;  // one after the other, or all at once
            reply(work, 0);
        }
        EXPECT_NEAR(scheduler.order().completion_time(0, 1), 1, places == 1 ? 1e-12 : 0.8) << places;
    }
}

TEST_F(SchedulerOfHosts, GivesAHostAsMuchMoreAsItHasPlaces) {
    join({0, 0, 1, {100, 1000, 1000}, 0, 1});
    join({1, 1, 2, {100, 1000, 1000}, 0, 3});
    add(101), add(102);
    tick();
    for (const auto& [sent, copy] : std::map(copies))
        if (sent.first > 100) tell(Scheduler::Replied{copy, 0, 1.0});
    copies.clear();
    for (Scheduler::WorkId work = 1; work <= 40; ++work) add(work);
    Replicas to = tick();
    EXPECT_NEAR(double(std::count(to.begin(), to.end(), 1u)), 30, 1);
}

TEST_F(SchedulerOfHosts, GivesRegionsToHostsByTheirPlaces) {
    Scheduler::Rules rules;
    rules.strategy = Strategy::affinity;
    scheduler = Scheduler(rules);
    join({0, 0, 1, {}, 0, 1});
    join({1, 1, 2, {}, 0, 7});
    std::size_t large = 0;
    for (std::uint64_t region = 0; region < 4000; ++region) large += scheduler.replicas().home(region) == 1;
    EXPECT_NEAR(double(large), 3500, 350);
    tell(Scheduler::Resized{1, 1, {}});
    std::size_t still = 0;
    for (std::uint64_t region = 0; region < 4000; ++region) still += scheduler.replicas().home(region) == 1;
    EXPECT_NEAR(double(still), 2000, 600);
}

TEST_F(SchedulerOfHosts, KeepsWhatAHostHasWhenItsPlacesChange) {
    join({0, 0, 1, {1, 1000, 1000}, 0, 1});
    add(1), add(2);
    EXPECT_EQ(tick(), (Replicas{0}));
    tell(Scheduler::Resized{0, 2, {2, 2000, 2000}});
    EXPECT_EQ(scheduler.replicas().places(), 2u);
    EXPECT_EQ(tick(), (Replicas{0}));
    reply(1, 0);
    EXPECT_TRUE(did<Scheduler::Accept>());
    tell(Scheduler::Gone{{0}});
    EXPECT_EQ(scheduler.replicas().places(), 0u);
}

TEST_F(SchedulerOfHosts, ForgetsWorkThatNobodyWants) {
    join({0, 0, 1, {1, 1000, 1 << 20}});
    add(1), add(2);
    tick();
    tell(Scheduler::Forgotten{1}), tell(Scheduler::Forgotten{2});
    EXPECT_EQ(scheduler.backlog().size(), 0u);
    EXPECT_EQ(tick(), (Replicas{})) << "its place is at it";
    reply(1, 0);
    EXPECT_TRUE(did<Scheduler::Drop>());
    EXPECT_TRUE(scheduler.has_room());
}

}  // namespace
}  // namespace lightnet::scheduler_hosts_test
