// Runs that may have to end early always have a picture that is that of a whole run of fewer samples.
#include "tools/session/film_steps.hpp"

#include <gtest/gtest.h>

#include <deque>

namespace lightnet::film_steps_test {
namespace {

using namespace std::chrono_literals;
using Seconds = std::chrono::duration<double>;

constexpr std::uint32_t tile_side = 4;

FilmFormat format_of(std::uint32_t samples, float error = 0) { return {8, 8, {"light"}, samples, {}, {error, 48}}; }

// What a place answers: samples that differ from pixel to pixel and have no exact sums, block by block.
std::vector<Rgb> rendered(const Tile& tile) {
    std::vector<Rgb> pixels(tile.told());
    for (const Tile& block : one_by_one(tile))
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            const auto x = tile.x + std::uint32_t(i % tile.columns()) * tile.step();
            const auto y = tile.y + std::uint32_t(i / tile.columns()) * tile.step();
            Rgb sum;
            for (std::uint32_t s = 0; s < block.samples; ++s) {
                const auto hash = (y * 8 + x) * 7919 + (block.first_sample + s) * 104729;
                sum += Rgb{1, 0.7f, 0.1f} * (0.1f + (x < 4 ? float(hash % 1000) / 999 : 0.5f));
            }
            pixels[i] += sum;
        }
    return pixels;
}

class FilmStepsTest : public ::testing::Test {
protected:
    // Renders step by step; a sample of one pixel costs so many seconds. Ends at tiles.
    void go_on(FilmSteps& steps, double cost) {
        for (auto tiles = steps.next(now()); !tiles.empty(); tiles = steps.next(now())) {
            steps.begin(now());
            std::deque<Tile> wanted(tiles.begin(), tiles.end());
            for (; !wanted.empty() && !steps.limit().over(now()); wanted.pop_front()) {
                spent += cost * wanted.front().samples * double(wanted.front().pixels());
                Film& film = steps.film_of(wanted.front());
                film.add(wanted.front(), rendered(wanted.front()));
                for (const Tile& more : film.more(wanted.front())) wanted.push_back(more);
            }
            if (!wanted.empty()) break;
        }
        steps.end();
    }
    // What `samples` per pixel give without a limit.
    Picture at_once(std::uint32_t samples, float error = 0) {
        FilmSteps all(format_of(samples, error), tile_side);
        go_on(all, 0);
        EXPECT_TRUE(all.finished());
        return all.picture().picture();
    }
    TimeLimit limit(double seconds) const { return {Seconds(seconds), now()}; }
    TimeLimit::Time now() const { return TimeLimit::Time{} + std::chrono::ceil<Pace::Clock::duration>(Seconds(spent)); }
    double spent = 0;
};

TEST_F(FilmStepsTest, EndsInTimeWithThePictureOfSoManySamples) {
    const double block_of_all = 64 * 16;  // at a second for each sample
    for (const double time : {70.0, 200.0, 900.0, block_of_all * 1.1, block_of_all * 2.5, block_of_all * 9.3}) {
        FilmSteps steps(format_of(1000), tile_side);
        const double begun = spent;
        steps.limit(limit(time));
        go_on(steps, 1);
        EXPECT_LE(spent - begun, time + 16 * 16);
        ASSERT_TRUE(steps.picture().complete());
        const auto samples = steps.picture().format().samples;
        EXPECT_TRUE(steps.picture().picture() == at_once(samples)) << samples;
        EXPECT_GE(samples + 1, time * 0.5 / 64) << time;
        EXPECT_LE(samples, time / 64) << time;
    }
}

TEST_F(FilmStepsTest, FallsBackToWhatAllPixelsHaveWhenAStepTakesLonger) {
    FilmSteps steps(format_of(1000), tile_side);
    steps.limit(limit(10'000));
    auto tiles = steps.next(now());
    for (int step = 0; step < 3; ++step) {
        steps.begin(now());
        for (const Tile& tile : tiles) {
            steps.film().add(tile, rendered(tile));
            spent += tile.samples * double(tile.pixels());
        }
        tiles = steps.next(now());
        ASSERT_FALSE(tiles.empty());
    }
    const auto finished = steps.picture().format().samples;
    steps.film().add(tiles[0], rendered(tiles[0]));  // and then nothing comes
    spent += 100'000;
    steps.end();
    EXPECT_EQ(steps.picture().format().samples, finished);
    EXPECT_TRUE(steps.picture().picture() == at_once(finished));
    EXPECT_TRUE(steps.next(now()).empty());
}

TEST_F(FilmStepsTest, ShowsWhatThereIsWhereNotEvenASampleFits) {
    FilmSteps steps(format_of(1000), tile_side);
    steps.limit(limit(40));
    go_on(steps, 1);
    EXPECT_FALSE(steps.picture().complete());
    EXPECT_GT(steps.picture().covered(), 0);
    EXPECT_LT(steps.picture().covered(), 1);
}

TEST_F(FilmStepsTest, GoesOnLaterToTheSameBytes) {
    for (const float error : {0.f, 0.05f}) {
        const Picture expected = at_once(200, error);
        FilmState kept;
        for (const double time : {100.0, 900.0, 2000.0, 2500.0, 100'000.0}) {
            FilmSteps steps(format_of(200, error), tile_side);
            if (!kept.parts.empty()) steps.restore(kept);
            const auto before = steps.picture().mean_samples();
            steps.limit(limit(time));
            go_on(steps, 1);
            EXPECT_GE(steps.picture().mean_samples(), before);
            if (steps.picture().complete()) {
                const auto samples = steps.picture().format().samples;
                EXPECT_TRUE(steps.picture().picture() == at_once(samples, error)) << samples;
            }
            kept = steps.film().state();
            if (steps.finished()) {
                EXPECT_TRUE(steps.picture().picture() == expected);
            }
        }
        FilmSteps last(format_of(200, error), tile_side);
        last.restore(kept);
        go_on(last, 1);
        EXPECT_TRUE(last.picture().picture() == expected);
    }
}

TEST_F(FilmStepsTest, BeginWithACoarseLookWhereSomebodyWaits) {
    for (const float error : {0.f, 0.05f}) {
        FilmSteps steps(format_of(300, error), tile_side);
        steps.by_groups(true);
        const auto coarse = steps.next(now());
        for (const Tile& tile : coarse) {
            EXPECT_TRUE(tile.coarse && !tile.rehearses() && tile.samples == 1);
            EXPECT_FALSE(steps.picture().complete());
            steps.film_of(tile).add(tile, rendered(tile));
        }
        EXPECT_TRUE(steps.picture().complete() && steps.picture().format().coarse);
        EXPECT_EQ(steps.picture().mean_samples(), 0.25);
        EXPECT_EQ(steps.film().done(), 0) << "nothing of it stays";
        const auto tiles = steps.next(now());
        EXPECT_EQ(tiles.front().samples, 1u);
        for (const Tile& tile : tiles) {
            EXPECT_TRUE(steps.picture().format().coarse);
            steps.film_of(tile).add(tile, rendered(tile));
        }
        EXPECT_EQ(steps.picture().mean_samples(), 1);
        go_on(steps, 0);
        EXPECT_TRUE(steps.finished());
        EXPECT_TRUE(steps.picture().picture() == at_once(300, error));
    }
}

TEST_F(FilmStepsTest, HaveNothingOfACoarseLookAtTheEnd) {
    FilmSteps steps(format_of(300), tile_side);
    steps.by_groups(true);
    for (const Tile& tile : steps.next(now())) steps.film_of(tile).add(tile, rendered(tile));
    steps.end();
    EXPECT_EQ(steps.picture().covered(), 0);
    Tile coarse{0, 0, 4, 4, 0, 1, coarse_stride, 1};
    EXPECT_THROW(steps.film_of(coarse).add(coarse, rendered(coarse)), Error);
}

TEST_F(FilmStepsTest, LooksAtEachGroupOfBlocksWhereThatIsWanted) {
    FilmSteps steps(format_of(300), tile_side);
    steps.by_groups();
    std::vector<std::uint32_t> seen;
    for (auto tiles = steps.next(now()); !tiles.empty(); tiles = steps.next(now())) {
        for (const Tile& tile : tiles) steps.film().add(tile, rendered(tile));
        seen.push_back(static_cast<std::uint32_t>(steps.film().mean_samples()));
    }
    EXPECT_EQ(seen, (std::vector<std::uint32_t>{16, 32, 64, 128, 256, 300}));
    EXPECT_TRUE(steps.picture().picture() == at_once(300));
}

TEST_F(FilmStepsTest, OfACancelledRunIsWhatEachPixelHas) {
    FilmSteps steps(format_of(300), tile_side);
    const auto tiles = steps.next(now());
    for (const Tile& tile : tiles)
        if (tile.block() < 2) steps.film().add(tile, rendered(tile));
    FilmSteps even(format_of(300), tile_side);
    even.restore(steps.film().state());
    even.end();
    EXPECT_TRUE(even.picture().picture() == at_once(32)) << "where all have as many";
    steps.film().add({0, 0, 4, 4, 32, 16}, rendered({0, 0, 4, 4, 32, 16}));
    steps.end();
    const Picture picture = steps.picture().picture();
    EXPECT_EQ(picture.samples.front(), 48);
    EXPECT_EQ(picture.samples.back(), 32);
    EXPECT_EQ(picture.layers[0].pixels.front(), at_once(48).layers[0].pixels.front());
}

}  // namespace
}  // namespace lightnet::film_steps_test
