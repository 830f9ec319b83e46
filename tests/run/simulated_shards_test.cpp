// Whole calls of shards, on a clock of their own.
#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <queue>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/network/light/mapped.hpp"
#include "core/run/master/shard_dealer.hpp"
#include "tests/support/fake_channel.hpp"

namespace lightnet::simulated_shards_test {
namespace {

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
    double now = 0;
    ShardDealer::Job job;
    job.count = static_cast<std::uint32_t>(costs.size());
    job.clock = [&now] { return now; };
    job.done = [&story](std::uint32_t first, const Bytes& joined) {
        for (const auto& result : split_shards(joined)) story.answered[first++] += result.size() == 1;
    };
    ShardDealer dealer(std::move(job));
    std::deque<test::FakeChannel<Step>> channels;
    for (std::size_t i = 0; i < places.size(); ++i) channels.emplace_back(2).where = std::to_string(i);
    std::vector<bool> lost(places.size(), false);
    const auto use = [&] {
        std::vector<Channel<Step>*> there;
        for (std::size_t i = 0; i < places.size(); ++i)
            if (!lost[i]) there.push_back(&channels[i]);
        dealer.use(there);
        return there.size();
    };
    struct Event {
        double time;
        Bundle<Step> bundle;  // no questions: somebody looks around
        std::uint32_t count;
        bool operator<(const Event& other) const { return time > other.time; }
    };
    std::priority_queue<Event> events;
    events.push({0, {}, 0});
    std::vector<double> busy(places.size(), 0);
    std::size_t copies = use();
    while (dealer.missing() > 0) {
        const Event event = events.top();
        events.pop();
        now = event.time;
        if (now > 1e5) throw std::runtime_error("nothing comes to an end");
        if (!event.bundle.questions) {
            events.push({now + 0.02, {}, 0});
            for (std::size_t i = 0; i < places.size(); ++i)
                if (now > places[i].dies + lease) lost[i] = true;
            copies = use();
        } else {
            event.bundle.owner->answered(event.bundle,
                                         join_shards(std::vector<std::vector<std::byte>>(event.count, {std::byte{}})));
        }
        story.seconds = now;
        dealer.deal(copies, true);
        for (std::size_t at = 0; at < places.size(); ++at)
            for (auto& sent = channels[at].sent; !sent.empty(); sent.pop_front()) {
                const Step& step = sent.front().questions->front();
                const double begun = std::max(busy[at], now + delay);
                double end = begun;
                std::uint32_t count = 0;
                while (count < step.count && (count == 0 || end - begun < 0.05))
                    end += costs[step.first + count++] * places[at].slowness;
                busy[at] = end;
                story.done += count;
                if (end < std::min(places[at].dies, places[at].hangs)) events.push({end + delay, sent.front(), count});
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
}  // namespace lightnet::simulated_shards_test
