#include "core/run/master/shard_dealer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <queue>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace lightnet::shard_dealer_test {
namespace {

constexpr Shards only(std::uint32_t shard) { return {shard, 1}; }

// Tells a dealer stories about the places a, b and c, each on a host of its own.
class ShardDealerTest : public ::testing::Test {
protected:
    static NodeCopy copy(const std::string& host) { return {{host, 0}, 0}; }
    void begin(std::uint32_t count, const std::vector<std::string>& hosts) {
        dealer.begin(count);
        for (const auto& host : hosts) join(host);
    }
    void join(const std::string& host, std::uint64_t process = 1) {
        there.insert(copy(host));
        plan.places.push_back(copy(host).place);
        dealer.join(copy(host), process, now);
    }
    // What each is told to do.
    std::map<std::string, std::vector<Shards>> deal() {
        std::map<std::string, std::vector<Shards>> dealt;
        for (const auto& deal : dealer.deal(there.size(), now)) {
            dealt[deal.to.place.host].push_back(deal.shards);
            ids[{deal.to.place.host, deal.shards.first}] = deal.id;
        }
        return dealt;
    }
    bool answer(const std::string& host, std::uint32_t first, std::uint32_t count = 1) {
        return dealer.answered(ids.at({host, first}), count, now);
    }
    void lose(const std::string& host) {
        there.erase(copy(host));
        std::erase(plan.places, copy(host).place);
        dealer.keep(plan, there, now);
    }
    using Dealt = std::map<std::string, std::vector<Shards>>;

    ShardDealer dealer;
    Plan plan;
    std::set<NodeCopy> there;
    std::map<std::pair<std::string, std::uint32_t>, ShardDealer::CopyId> ids;
    double now = 0;
};

TEST_F(ShardDealerTest, GivesEachShardOnceAndTheLastOnesToThoseWhoAreIdle) {
    begin(5, {"a", "b"});
    EXPECT_EQ(deal(), (Dealt{{"a", {only(0), only(2)}}, {"b", {only(1)}}})) << "two are left, for who is idle first";
    now = 1;
    EXPECT_TRUE(answer("a", 0));
    EXPECT_EQ(deal(), Dealt{}) << "it still has one";
    EXPECT_TRUE(answer("b", 1));
    EXPECT_EQ(deal(), (Dealt{{"b", {only(3)}}}));
    now = 2;
    EXPECT_TRUE(answer("a", 2));
    EXPECT_EQ(deal(), (Dealt{{"a", {only(4)}}}));
    EXPECT_TRUE(answer("b", 3));
    EXPECT_EQ(deal(), Dealt{}) << "nobody is late";
    now = 2.5;
    EXPECT_EQ(deal(), Dealt{});
}

TEST_F(ShardDealerTest, GivesWhatSomebodyIsLateWithToWhoIsIdle) {
    begin(2, {"a", "b"});
    EXPECT_EQ(deal(), (Dealt{{"a", {only(0)}}, {"b", {only(1)}}}));
    now = 0.1;
    answer("a", 0);
    now = 0.35;
    EXPECT_EQ(deal(), Dealt{}) << "it was to take as long as the other one, after that";
    now = 0.45;
    EXPECT_EQ(deal(), (Dealt{{"a", {only(1)}}}));
    EXPECT_TRUE(answer("a", 1));
    EXPECT_FALSE(answer("b", 1)) << "the first answer counts";
}

TEST_F(ShardDealerTest, GivesOutAgainWhatALostPlaceHad) {
    begin(2, {"a", "b"});
    deal();
    lose("b");
    answer("a", 0);
    EXPECT_EQ(deal(), (Dealt{{"a", {only(1)}}}));
    EXPECT_FALSE(answer("b", 1));
}

TEST_F(ShardDealerTest, AsksNobodyWhoWasToldToStop) {
    begin(6, {"a", "b"});
    deal();
    there.erase(copy("b"));
    dealer.keep(plan, there, now);  // the place is there
    EXPECT_TRUE(answer("b", 1)) << "it answers what it has";
    answer("a", 0), answer("a", 2);
    const auto more = deal();
    EXPECT_TRUE(more.contains("a"));
    EXPECT_FALSE(more.contains("b"));
}

TEST_F(ShardDealerTest, GivesSeveralTogetherWhileThereAreManyAndTheRestOfThemToOthers) {
    begin(20, {"a", "b"});
    const auto first = deal();
    EXPECT_EQ(first.at("a").front(), (Shards{0, 3}));
    EXPECT_EQ(first.at("b").front(), (Shards{3, 2}));
    now = 1;
    EXPECT_TRUE(answer("b", 3, 1)) << "it did one of them";
    const auto more = deal();
    ASSERT_TRUE(more.contains("b"));
    EXPECT_EQ(more.at("b").front(), only(4));
}

TEST_F(ShardDealerTest, AsksSomebodyElseWhereOneFailed) {
    begin(1, {"a", "b"});
    const auto first = deal();
    const std::string sick = first.begin()->first, healthy = sick == "a" ? "b" : "a";
    EXPECT_TRUE(dealer.failed(ids.at({sick, 0}), now));
    EXPECT_EQ(deal(), (Dealt{{healthy, {only(0)}}}));
    EXPECT_TRUE(answer(healthy, 0));
    EXPECT_FALSE(dealer.failed(ids.at({sick, 0}), now)) << "it came late";
}

TEST_F(ShardDealerTest, KeepsWhatFailedForThoseWhoComeLater) {
    begin(1, {"a"});
    deal();
    EXPECT_TRUE(dealer.failed(ids.at({"a", 0}), now));
    lose("a");
    join("b");
    EXPECT_EQ(deal(), (Dealt{{"b", {only(0)}}}));
}

TEST_F(ShardDealerTest, NamesTheShardThatKillsHostsThoughItWentWithOthers) {
    begin(12, {"a"});
    constexpr std::uint32_t poison = 4;
    std::set<std::uint32_t> done;
    for (std::uint64_t process = 2; process < 200 && !dealer.convicted(); ++process) {
        bool died = false;
        for (const auto& [host, all] : deal())
            for (const auto& some : all) {
                died = died || (some.first <= poison && poison < some.first + some.count);
                if (died) continue;
                EXPECT_TRUE(answer(host, some.first, some.count));
                for (auto shard = some.first; shard < some.first + some.count; ++shard) done.insert(shard);
            }
        if (!died) continue;
        lose("a");
        join("a", process);
    }
    ASSERT_TRUE(dealer.convicted());
    EXPECT_EQ(dealer.convicted()->shard, poison);
    EXPECT_EQ(dealer.convicted()->hosts, (std::vector<std::string>{"a", "a", "a"}));
    EXPECT_FALSE(done.contains(poison));
}

TEST_F(ShardDealerTest, ForgetsTheRoundBeforeWhenItBeginsAgain) {
    begin(1, {"a"});
    deal();
    const auto before = ids.at({"a", 0});
    dealer.begin(1);
    EXPECT_EQ(deal(), Dealt{}) << "nobody has joined";
    dealer.join(copy("a"), 1, now);
    deal();
    EXPECT_FALSE(dealer.answered(before, 1, now));
    EXPECT_TRUE(answer("a", 0));
}

// ---- whole calls, on a clock of their own ----

// A place that does shards as Preparer does: several, until a twentieth of a second is over.
struct SimulatedPlace {
    double slowness = 1;
    double dies = 1e9, hangs = 1e9;  // when
};

struct Story {
    double seconds = 0;           // until the last result was there
    double work = 0;              // that had to be done, in seconds of a place of slowness 1
    std::size_t done = 0;         // shards that places did, twice or not
    std::vector<int> answered{};  // by shard: how often its answer counted
};

Story play(const std::vector<double>& costs, const std::vector<SimulatedPlace>& places) {
    constexpr double delay = 0.0005, lease = 1.5;
    Story story;
    story.answered.resize(costs.size());
    for (const double cost : costs) story.work += cost;
    ShardDealer dealer;
    dealer.begin(static_cast<std::uint32_t>(costs.size()));
    Plan plan;
    std::set<NodeCopy> there;
    for (std::size_t i = 0; i < places.size(); ++i) {
        there.insert({{std::to_string(i), 0}, 0});
        plan.places.push_back({std::to_string(i), 0});
        dealer.join({{std::to_string(i), 0}, 0}, 1, 0);
    }
    struct Event {
        double time;
        ShardDealer::CopyId id;  // 0: somebody looks around
        Shards shards;
        std::size_t place;
        bool operator<(const Event& other) const { return time > other.time; }
    };
    std::priority_queue<Event> events;
    events.push({0, 0, {}, 0});
    std::vector<double> busy(places.size(), 0);
    std::vector<bool> lost(places.size(), false);
    for (std::size_t missing = costs.size(); missing > 0;) {
        const Event event = events.top();
        events.pop();
        const double now = event.time;
        if (now > 1e5) throw std::runtime_error("nothing comes to an end");
        if (event.id == 0) {
            events.push({now + 0.02, 0, {}, 0});
            for (std::size_t i = 0; i < places.size(); ++i)
                if (!lost[i] && now > places[i].dies + lease) {
                    lost[i] = true;
                    there.erase({{std::to_string(i), 0}, 0});
                    std::erase(plan.places, PlaceAt{std::to_string(i), 0});
                    dealer.keep(plan, there, now);
                }
        } else if (const auto shards = dealer.shards_of(event.id); shards) {
            if (dealer.answered(event.id, event.shards.count, now)) {
                missing -= event.shards.count;
                for (std::uint32_t i = 0; i < event.shards.count; ++i) ++story.answered[event.shards.first + i];
            }
        }
        story.seconds = now;
        for (const auto& deal : dealer.deal(there.size(), now)) {
            const auto at = static_cast<std::size_t>(std::stoul(deal.to.place.host));
            const double begun = std::max(busy[at], now + delay);
            double end = begun;
            std::uint32_t count = 0;
            while (count < deal.shards.count && (count == 0 || end - begun < 0.05))
                end += costs[deal.shards.first + count++] * places[at].slowness;
            busy[at] = end;
            story.done += count;
            if (end < std::min(places[at].dies, places[at].hangs))
                events.push({end + delay, deal.id, {deal.shards.first, count}, at});
        }
    }
    return story;
}

// Some cost twice as much as others.
std::vector<double> uneven(std::size_t count, double mean, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::vector<double> costs(count);
    for (auto& cost : costs) cost = mean * (2.0 / 3 + 2.0 / 3 * double(random() >> 11) * 0x1p-53);
    return costs;
}

void expect_each_once(const Story& story) {
    for (const int times : story.answered) EXPECT_EQ(times, 1);
}

TEST(SimulatedShards, AreHardlyEverDoneTwiceAndKeepAllPlacesBusy) {
    std::size_t done = 0, shards = 0;
    double efficiency = 0;
    constexpr int seeds = 100;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        const auto costs = uneven(200, seed % 2 ? 0.002 : 0.05, seed);
        const auto story = play(costs, std::vector<SimulatedPlace>(2 + seed % 3));
        expect_each_once(story);
        done += story.done, shards += costs.size();
        efficiency += story.work / double(2 + seed % 3) / story.seconds / seeds;
    }
    EXPECT_LE(double(done), 1.01 * double(shards));
    EXPECT_GT(efficiency, 0.97);
}

TEST(SimulatedShards, WaitForNoPlaceThatIsSlow) {
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
        const auto costs = uneven(100, 0.05, seed);
        const auto story = play(costs, {{1}, {1}, {1}, {20}});
        expect_each_once(story);
        EXPECT_LT(story.seconds, 1.25 * story.work / 3) << "seed " << seed << ": slower than without the slow one";
    }
}

TEST(SimulatedShards, WaitForADeadPlaceNoLongerThanItTakesToMissIt) {
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        const auto costs = uneven(100, 0.05, seed);
        SimulatedPlace dying;
        dying.dies = 0.02 * double(seed);
        const auto story = play(costs, {{1}, dying, {1}});
        expect_each_once(story);
        EXPECT_LT(story.seconds, 2 + story.work / 2) << "seed " << seed;
    }
}

TEST(SimulatedShards, AreDoneElsewhereWhenTheirPlaceHangsAndIsNeverMissed) {
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        const auto costs = uneven(100, 0.05, seed);
        SimulatedPlace hanging;
        hanging.hangs = 0.02 * double(seed + 10);
        const auto story = play(costs, {{1}, hanging, {1}});
        expect_each_once(story);
        EXPECT_LT(story.seconds, 1 + story.work / 2) << "seed " << seed;
    }
}

}  // namespace
}  // namespace lightnet::shard_dealer_test
