// Tiles that come back whole, once, and whatever time they take.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <random>
#include <set>
#include <tuple>
#include <vector>

#include "core/run/master/master_renderer.hpp"

namespace lightnet::tiles_whole_test {
namespace {

constexpr std::uint64_t run_number = 1;
constexpr std::uint32_t image = 0;

/// Two places that answer in an order, and take times, by chance.
class Chance final : public Carrier {
public:
    explicit Chance(unsigned seed) : random_(seed) {}

    bool ask(const PlaceAt&, Message& message) override {
        asked_.push_back(std::move(message));
        return true;
    }
    void reply(Message) override {}
    std::optional<Message> receive() override {
        if (asked_.empty() || random_() % 3 == 0) return std::nullopt;
        std::swap(asked_.front(), asked_[random_() % asked_.size()]);
        auto ask = std::move(asked_.front());
        asked_.pop_front();
        const auto& tiles = *std::get<Questions<Tile>>(ask.questions);
        if (random_() % 8 == 0) pace_ = std::exp2(double(random_() % 6) - 5);  // the machine has more or less to do
        for (const Tile& tile : tiles) now_ += pace_ * double(tile.pixels() * tile.blocks()) / 1024;
        auto reply = reply_to(ask);
        reply.answers.resize(answers_to(tiles, ask.width));
        return reply;
    }
    void wait(std::chrono::nanoseconds most) override {
        now_ += std::min(std::chrono::duration<double>(most).count(), .1);
    }
    void forget(const PlaceAt&) override {}
    const Counters& counters() const override { return counters_; }
    double now() const { return now_; }

private:
    std::mt19937 random_;
    std::deque<Message> asked_;
    Counters counters_;
    double now_ = 1, pace_ = 0.1;  // seconds; seconds of a block of 32 × 32 pixels
};

// A picture of 48 × 48 pixels, cut at 32: tiles of four sizes, each with its samples in groups.
std::vector<Tile> tiles() {
    std::vector<Tile> all;
    constexpr std::uint32_t blocks = 32;
    for (std::uint32_t block = 0; block < blocks; block += group_of(block).count)
        for (const std::uint32_t y : {0u, 32u})
            for (const std::uint32_t x : {0u, 32u})
                all.push_back({x, y, x ? 16u : 32u, y ? 16u : 32u, block * samples_per_block,
                               group_of(block).count * samples_per_block});
    return all;
}

using Rectangle = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>;
Rectangle rectangle(const Tile& tile) { return {tile.x, tile.y, tile.width, tile.height}; }

TEST(TilesByChance, AreTakenInWholeAndOnce) {
    std::set<Rectangle> known;
    for (const Tile& tile : tiles()) known.insert(rectangle(tile));
    for (unsigned seed = 1; seed <= 100; ++seed) {
        Chance places(seed);
        MasterRenderer::Job job;
        job.run = run_number, job.image = image, job.tiles = tiles();
        job.credit = {3, 3 * MasterRenderer::most_together};
        job.clock = [&] { return places.now(); };
        std::map<Rectangle, std::set<std::uint32_t>> taken;  // blocks
        MasterRenderer master(std::move(job), places, [&](const Tile& tile, std::span<const Rgb> pixels) {
            EXPECT_TRUE(known.contains(rectangle(tile))) << seed << ": a piece at " << tile.x << "," << tile.y;
            EXPECT_EQ(pixels.size(), tile.pixels());
            for (std::uint32_t i = 0; i < tile.blocks(); ++i)
                EXPECT_TRUE(taken[rectangle(tile)].insert(tile.block() + i).second) << seed << ": twice";
        });
        Plan plan{{{"", 0}, {"", 1}}, {{0, 1}}};
        master.use(plan);
        for (int turn = 0; turn < 100000 && !master.work(std::chrono::milliseconds(100)); ++turn) {
        }
        ASSERT_EQ(taken.size(), known.size()) << seed;
        for (const auto& [where, blocks] : taken) ASSERT_EQ(blocks.size(), 32u) << seed;
        if (HasFailure()) return;
    }
}

}  // namespace
}  // namespace lightnet::tiles_whole_test
