// The parts of a scheduler that keep state of their own, each alone.
#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <vector>

#include "core/run/schedule/hash_ring.hpp"
#include "core/run/schedule/in_flight.hpp"
#include "core/run/schedule/service_times.hpp"
#include "core/run/schedule/stragglers.hpp"
#include "core/run/schedule/suspects.hpp"
#include "core/run/schedule/tournament_tree.hpp"

namespace lightnet::scheduler_parts_test {
namespace {

TEST(TournamentTree, KnowsTheLowestKeyThroughAllChanges) {
    TournamentTree lowest;
    std::map<std::size_t, double> keys;
    std::uint64_t random = 1;
    for (int change = 0; change < 5000; ++change) {
        random = random * 6364136223846793005ull + 1442695040888963407ull;
        const std::size_t number = (random >> 33) % 37;
        const double key = (random >> 40) % 5 == 0 ? TournamentTree::none : static_cast<double>((random >> 45) % 100);
        lowest.set(number, key);
        keys[number] = key;
        auto first = keys.begin();
        for (auto it = keys.begin(); it != keys.end(); ++it)
            if (it->second < first->second) first = it;
        ASSERT_EQ(lowest.least(), first->second);
        ASSERT_TRUE(!lowest.any() || lowest.first() == first->first);
    }
}

// ---- HashRing ----

TEST(HashRing, GivesEveryOwnerAFairShare) {
    HashRing ring;
    for (HashRing::Owner owner = 0; owner < 4; ++owner) ring.add(owner, 100 + owner);
    std::map<HashRing::Owner, int> keys;
    for (std::uint64_t key = 0; key < 4000; ++key) ++keys[ring.owner_of(key)];
    for (HashRing::Owner owner = 0; owner < 4; ++owner) EXPECT_GT(keys[owner], 400) << owner;
}

TEST(HashRing, GivesAnOwnerItsKeysBackUnderItsName) {
    HashRing ring;
    ring.add(0, 7), ring.add(1, 8);
    std::map<std::uint64_t, HashRing::Owner> before;
    for (std::uint64_t key = 0; key < 100; ++key) before[key] = ring.owner_of(key);
    ring.remove(1, 8);
    for (std::uint64_t key = 0; key < 100; ++key) EXPECT_EQ(ring.owner_of(key), 0u);
    ring.add(5, 8);
    for (const auto& [key, owner] : before) EXPECT_EQ(ring.owner_of(key), owner == 1 ? 5 : 0);
}

TEST(HashRing, IsEmptyWhenTheLastOwnerHasGone) {
    HashRing ring;
    ring.add(3, 1);
    EXPECT_FALSE(ring.empty());
    ring.remove(3, 1);
    EXPECT_TRUE(ring.empty());
}

// ---- ServiceTimes ----

TEST(ServiceTimes, BelieveTheWorseOfWhatIsSeenAndWhatIsSaid) {
    ServiceTimes times;
    times.measure(0, 2, 10, 0.1);
    EXPECT_DOUBLE_EQ(times.of(0), 0.2);
    times.measure(0, 0, 0, 0.5);
    EXPECT_DOUBLE_EQ(times.of(0), 0.5);
}

TEST(ServiceTimes, LetThePastFade) {
    ServiceTimes times;
    times.measure(0, 10, 10, 0);
    for (int i = 0; i < 50; ++i) times.measure(0, 1, 10, 0);
    EXPECT_NEAR(times.of(0), 0.1, 1e-4);
}

TEST(ServiceTimes, AssumeTheMeanOfWhatIsNotMeasured) {
    ServiceTimes times;
    EXPECT_EQ(times.assumed(1), ServiceTimes::unknown);
    times.measure(0, 1, 2, 0);
    times.take_part(0, true);
    EXPECT_DOUBLE_EQ(times.rate(), 2);
    EXPECT_DOUBLE_EQ(times.assumed(1), 0.5);
    times.forget(0);
    EXPECT_FALSE(times.any());
    EXPECT_EQ(times.of(0), 0);
}

TEST(ServiceTimes, KnowHowMuchMoreThanTheMeanAPieceTook) {
    ServiceTimes times;
    EXPECT_EQ(times.spread(), 1);
    for (int i = 0; i < 10; ++i) times.measure(0, 1, 1, 0);
    EXPECT_NEAR(times.spread(), 1, 1e-9);
    times.measure(0, 5, 1, 0);
    EXPECT_NEAR(times.spread(), 5, 1e-9);
    times.measure(1, 100, 1, 0);
    EXPECT_LT(times.spread(), 5) << "of another replica nothing is known";
    for (int i = 0; i < 100; ++i) times.measure(0, 1, 1, 0);
    EXPECT_NEAR(times.spread(), 1, 0.1);
    times.measure(0, 1e6, 1, 0);
    EXPECT_LE(times.spread(), 16) << "one piece tells no more about the others";
}

TEST(ServiceTimes, KeepWhatReplicasSayOfTheirWorkApartFromWhatIsWaitedFor) {
    ServiceTimes times;
    EXPECT_EQ(times.said(), 0);
    times.measure(0, 2, 10, 0.1);
    EXPECT_DOUBLE_EQ(times.said(), 0.1);
    times.measure(1, 2, 10, 0);
    EXPECT_DOUBLE_EQ(times.said(), 0.1) << "who says nothing changes nothing";
    for (int i = 0; i < 50; ++i) times.measure(1, 2, 10, 0.3);
    EXPECT_NEAR(times.said(), 0.3, 1e-4);
}

// ---- InFlight ----

InFlight::Copy copy_of(InFlight::WorkId work, InFlight::Time overdue = 1) {
    return {.work = work, .questions = 10, .bytes = 100, .overdue = overdue};
}

TEST(InFlight, GivesCreditBackWithTheCopy) {
    InFlight in_flight;
    const auto first = in_flight.open(2, copy_of(7));
    in_flight.open(2, copy_of(8));
    EXPECT_EQ(in_flight.of(2).questions, 20u);
    EXPECT_EQ(in_flight.of(2).bytes, 200u);
    const auto closed = in_flight.close(first);
    ASSERT_TRUE(closed);
    EXPECT_EQ(closed->replica, 2u);
    EXPECT_EQ(closed->work, 7u);
    EXPECT_TRUE(closed->copy);
    EXPECT_EQ(in_flight.of(2).questions, 10u);
    EXPECT_EQ(in_flight.copies(), 1u);
    EXPECT_FALSE(in_flight.close(first)) << "a copy comes back once";
}

TEST(InFlight, RemembersWhatIsWrittenOffWithoutItsCredit) {
    InFlight in_flight;
    in_flight.open(0, copy_of(7, 5));
    const auto second = in_flight.open(0, copy_of(8, 3));
    EXPECT_EQ(in_flight.write_off_first(0).id, second);
    EXPECT_EQ(in_flight.of(0).copies.size(), 1u);
    EXPECT_EQ(in_flight.of(0).size(), 2u);
    EXPECT_EQ(in_flight.questions(), 10u);
    EXPECT_EQ(in_flight.work_of(second), 8u);
    const auto closed = in_flight.close(second);
    ASSERT_TRUE(closed);
    EXPECT_FALSE(closed->copy);
    EXPECT_EQ(in_flight.of(0).size(), 1u);
}

TEST(InFlight, ForgetsAllThatAReplicaHadWhenItIsGone) {
    InFlight in_flight;
    in_flight.open(0, copy_of(7, 5));
    const auto late = in_flight.open(0, copy_of(8, 3));
    const auto elsewhere = in_flight.open(1, copy_of(7));
    in_flight.write_off_first(0);
    EXPECT_EQ(in_flight.close_all(0).size(), 2u);
    EXPECT_FALSE(in_flight.replica_of(late));
    EXPECT_EQ(in_flight.replica_of(elsewhere), 1u);
    EXPECT_EQ(in_flight.copies(), 1u);
    EXPECT_EQ(in_flight.of(0).size(), 0u);
}

// ---- Suspects ----

TEST(Suspects, AreConvictedByDeathsAloneOnly) {
    Suspects suspects(2);
    EXPECT_FALSE(suspects.blame(1, {0, 10, false}));
    EXPECT_TRUE(suspects.is_suspect(1));
    EXPECT_FALSE(suspects.blame(1, {1, 11, true}));
    EXPECT_FALSE(suspects.blame(1, {1, 12, false}));
    EXPECT_TRUE(suspects.blame(1, {2, 13, true}));
    EXPECT_EQ(suspects.died_alone(1), (std::vector<Suspects::Host>{1, 2}));
}

TEST(Suspects, AreClearedWhenTheHostHadNotDied) {
    Suspects suspects(3);
    suspects.lost(0, 10);
    suspects.blame(1, {0, 10, true}), suspects.wait(1);
    suspects.blame(2, {0, 10, true}), suspects.blame(2, {1, 11, true}), suspects.wait(2);
    EXPECT_EQ(suspects.came_back(0, 12), std::vector<Suspects::WorkId>{}) << "another process";
    EXPECT_EQ(suspects.came_back(0, 10), std::vector<Suspects::WorkId>{1});
    EXPECT_FALSE(suspects.is_suspect(1));
    EXPECT_TRUE(suspects.is_suspect(2)) << "of another death";
    EXPECT_EQ(suspects.waiting(), 1u);
    EXPECT_EQ(suspects.front(), 2u);
}

// ---- Stragglers ----

TEST(Stragglers, KnowTheFirstAndTheLastOfAllReplicas) {
    Stragglers stragglers;
    EXPECT_EQ(stragglers.next_overdue(), TournamentTree::none);
    stragglers.set(0, {.overdue = 9, .late = 3, .last = 4});
    stragglers.set(1, {.overdue = 8, .late = 2, .last = 2});
    stragglers.set(2, {.overdue = 7});
    EXPECT_EQ(stragglers.overdue_at(), 2u);
    EXPECT_EQ(stragglers.late(), 2);
    EXPECT_EQ(stragglers.late_at(), 1u);
    EXPECT_EQ(stragglers.last_at(), 0u);
    EXPECT_EQ(stragglers.last(), 4);
    stragglers.set(0, {}), stragglers.set(1, {});
    EXPECT_EQ(stragglers.late(), TournamentTree::none);
    EXPECT_EQ(stragglers.last(), -TournamentTree::none);
}

}  // namespace
}  // namespace lightnet::scheduler_parts_test
