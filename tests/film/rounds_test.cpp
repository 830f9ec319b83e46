// Cells that end by what cleaning leaves of their noise.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <random>

#include "core/film/checkpoint.hpp"
#include "core/film/clean/clean.hpp"
#include "core/film/clean/rounds.hpp"
#include "core/film/clean_layers.hpp"
#include "core/film/film.hpp"
#include "tests/support/folder.hpp"

namespace lightnet::rounds_test {
namespace {

constexpr std::uint32_t width = 88, height = 40, least = 32;

FilmFormat format_of(float noise, std::uint32_t samples = 640, bool cleaned = true) {
    FilmFormat format{width, height, {"direct"}, samples, {}, {noise, least}};
    if (cleaned) format.shown = {cleaning::half_of("direct")};
    return format;
}

constexpr std::uint32_t even = 64;  // pixels of a row

// White at the left side, and at the right one black and white dots that nothing foretells.
float truth(std::uint32_t x, std::uint32_t y) {
    if (x < even) return 1;
    return std::mt19937(y * width + x)() % 2 ? 1.0f : 0.1f;
}

// What a renderer would answer: samples lie evenly between 0 and twice the truth.
std::vector<Rgb> rendered(const Tile& tile, const FilmFormat& format) {
    std::vector<Rgb> pixels;
    for (std::uint32_t y = tile.y; y < tile.y + tile.height; ++y)
        for (std::uint32_t x = tile.x; x < tile.x + tile.width; ++x) {
            std::mt19937 random((y * width + x) * 64 + tile.block());
            Rgb sum, second;
            for (std::uint32_t s = 0; s < tile.samples; ++s) {
                const float value = truth(x, y) * float(random() >> 8) * 0x2p-24f;
                sum += {value, value, value};
                if (s % samples_per_block >= samples_per_block / 2) second += {value, value, value};
            }
            pixels.push_back(sum);
            if (format.halves()) pixels.push_back(second);
        }
    return pixels;
}

// Takes tiles as they are wanted, `most` of them, with some under way that arrive in any order.
void render(Film& film, const std::vector<Tile>& first, unsigned seed = 0, std::size_t most = 1000000) {
    std::mt19937 random(seed);
    std::deque<Tile> wanted(first.begin(), first.end());
    std::vector<Tile> under_way;
    for (; (!wanted.empty() || !under_way.empty()) && most > 0; --most) {
        while (!wanted.empty() && under_way.size() < (seed ? 7 : 1)) {
            under_way.push_back(wanted.front());
            wanted.pop_front();
        }
        std::swap(under_way[random() % under_way.size()], under_way.back());
        const Tile tile = under_way.back();
        under_way.pop_back();
        EXPECT_TRUE(film.add(tile, rendered(tile, film.format()))) << "asked for twice";
        for (const Tile& more : film.more(tile)) wanted.push_back(more);
        for (const Tile& more : end_round_if_over(film)) wanted.push_back(more);
    }
}

Film finished(const FilmFormat& format, std::uint32_t tile_size = 16, unsigned seed = 0) {
    Film film(format);
    render(film, tiles_of(format, tile_size), seed);
    EXPECT_TRUE(film.complete());
    return film;
}

void go_on(Film& film) {
    std::vector<Tile> wanted;
    for (const Tile& tile : tiles_of(film.format(), 16))
        if (!film.has(tile)) wanted.push_back(tile);
    for (const Tile& tile : film.going_on()) wanted.push_back(tile);
    for (const Tile& tile : end_round_if_over(film)) wanted.push_back(tile);
    render(film, wanted);
}

TEST(Rounds, GiveTheSameBytesInAnyOrderAndForAnyTileSize) {
    const Picture picture = finished(format_of(0.04f)).picture();
    EXPECT_NE(picture.samples.front(), picture.samples.back());
    for (const std::uint32_t size : {8u, 64u})
        EXPECT_TRUE(finished(format_of(0.04f), size, size).picture() == picture) << size;
}

TEST(Rounds, SpendSamplesOnWhatCleaningLeaves) {
    const Picture picture = finished(format_of(0.04f)).picture();
    EXPECT_LE(picture.samples.front(), 2 * least) << "what is even needs few";
    EXPECT_GE(picture.samples.back(), 4 * least) << "dots must be rendered";
    for (const float samples : picture.samples)
        EXPECT_THAT(samples / 16, testing::AnyOf(2, 3, 4, 6, 9, 13, 19, 28, 40)) << "half as many more by each round";
}

TEST(Rounds, TakeFewerSamplesThanCellsThatDecideByThemselves) {
    const double rounds = finished(format_of(0.04f)).mean_samples(),
                 alone = finished(format_of(0.04f, 640, false)).mean_samples();
    EXPECT_LT(rounds, alone / 1.5);  // in the even part of the picture
}

// Of white pixels the threshold is in parts of their brightness, and dots are not much darker.
TEST(Rounds, ReachTheirThreshold) {
    const Picture picture = clean(finished(format_of(0.04f)).picture()).picture;
    double sum = 0;
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x)
            sum += std::pow(picture.beauty[std::size_t{y} * width + x].g - truth(x, y), 2) / (width * height);
    EXPECT_LT(std::sqrt(sum), 1.2 * 0.04);
}

// What is expected is a mean over its surroundings, some of which black ones have: they are not held for it.
TEST(Rounds, EndBlackCellsBesideNoisyOnes) {
    const FilmFormat format{64, 16, {"direct"}, 640, {}, {0.015f, least}, {}, {cleaning::half_of("direct")}};
    Film film(format);
    std::mt19937 random(1);
    const auto tiles = tiles_of(format, 16);
    for (std::deque<Tile> wanted(tiles.begin(), tiles.end()); !wanted.empty(); wanted.pop_front()) {
        const Tile tile = wanted.front();
        std::vector<Rgb> pixels;
        for (std::uint32_t i = 0; i < tile.pixels(); ++i) {
            const bool black = tile.x + i % tile.width >= 32;
            const auto half = [&] { return black ? 0 : float(tile.samples) * float(random() >> 8) * 0x1p-25f; };
            const float first = half(), second = half();
            pixels.push_back(Rgb{1, 1, 1} * (first + second));
            pixels.push_back(Rgb{1, 1, 1} * second);
        }
        film.add(tile, pixels);
        for (const Tile& more : end_round_if_over(film)) wanted.push_back(more);
        for (const Tile& more : film.more(tile)) wanted.push_back(more);
    }
    const auto samples = film.picture().samples;
    EXPECT_GE(samples[0], 2 * least);
    EXPECT_LE(samples[40], samples[0]);
    EXPECT_EQ(samples[63], least);
}

TEST(Rounds, NeedNoMoreThanAllSamples) {
    const Picture picture = finished(format_of(1e-7f, 100)).picture();
    for (const float samples : picture.samples) EXPECT_EQ(samples, 100);
}

TEST(Rounds, GoOnWhereAnotherRunEnded) {
    const test::Folder folder;
    const auto format = format_of(0.04f);
    const Picture picture = finished(format).picture();
    for (const std::size_t done : {3u, 35u, 36u, 60u}) {
        Film ended(format), film(format);
        render(ended, tiles_of(format, 16), 0, done);
        write_checkpoint(folder / "x", {{}, ended.state()});
        film.restore(read_checkpoint(folder / "x")->film);
        go_on(film);
        EXPECT_TRUE(film.complete());
        EXPECT_TRUE(film.picture() == picture) << done;
    }
}

TEST(Rounds, GoOnWithMoreSamplesAsIfTheyHadHadThem) {
    const Picture picture = finished(format_of(0.02f)).picture();
    for (const std::uint32_t had : {112u, 144u}) {  // the last round was no whole one, or had no need to be judged
        Film film = finished(format_of(0.02f, had)).of_samples(640);
        EXPECT_FALSE(film.complete());
        go_on(film);
        EXPECT_TRUE(film.picture() == picture) << had;
    }
}

TEST(Rounds, KnowNothingOfGains) {
    auto format = format_of(0.04f);
    format.gains = {{0.1f, 4, 0}};
    EXPECT_EQ(finished(format).picture().samples, finished(format_of(0.04f)).picture().samples);
}

}  // namespace
}  // namespace lightnet::rounds_test
