// Samples where they are needed, and pictures cut out of larger ones.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <random>

#include "core/base/error.hpp"
#include "core/film/film.hpp"

namespace lightnet::refinement_test {
namespace {

constexpr std::uint32_t width = 37, height = 21, samples = 16 * 40;

FilmFormat format_of(float noise, std::optional<Window> crop = {}) {
    return {width, height, {"emission", "direct"}, samples, crop, {noise, 64}};
}

// What a renderer would answer. Noise grows from the left to the right; the leftmost pixels have none.
std::vector<Rgb> rendered(const Tile& tile) {
    std::vector<Rgb> pixels;
    for (std::uint32_t y = tile.y; y < tile.y + tile.height; ++y)
        for (std::uint32_t x = tile.x; x < tile.x + tile.width; ++x) {
            std::mt19937 random((y * width + x) * 64 + tile.block());
            const float noise = x < 8 ? 0 : float(x) / width;
            for (int layer = 0; layer < 2; ++layer) {
                Rgb sum;
                for (std::uint32_t s = 0; s < tile.samples; ++s) {
                    const float value = 0.5f + noise * (float(random() % 1000) / 500 - 1);
                    sum += {value, value, value};
                }
                pixels.push_back(sum);
            }
        }
    return pixels;
}

// Renders with some tiles under way at any time, that arrive in any order.
Film finished(const FilmFormat& format, std::uint32_t tile_size, unsigned seed = 0) {
    Film film(format);
    std::mt19937 random(seed);
    const auto first = tiles_of(format, tile_size);
    std::deque<Tile> wanted(first.begin(), first.end());
    std::vector<Tile> under_way;
    while (!wanted.empty() || !under_way.empty()) {
        while (!wanted.empty() && under_way.size() < (seed ? 7 : 1)) {
            under_way.push_back(wanted.front());
            wanted.pop_front();
        }
        std::swap(under_way[random() % under_way.size()], under_way.back());
        const Tile tile = under_way.back();
        under_way.pop_back();
        EXPECT_TRUE(film.add(tile, rendered(tile))) << "asked for twice";
        for (const Tile& more : film.more(tile)) wanted.push_back(more);
    }
    EXPECT_TRUE(film.complete());
    EXPECT_EQ(film.done(), 1);
    return film;
}

TEST(Refinement, GivesTheSameBytesInAnyOrderAndForAnyTileSize) {
    const Picture picture = finished(format_of(0.03f), 8).picture();
    for (const std::uint32_t size : {1u, 8u, 11u, 16u, 64u})
        for (const unsigned seed : {0u, 1u, 2u})
            EXPECT_TRUE(finished(format_of(0.03f), size, seed).picture() == picture);
}

TEST(Refinement, SpendsSamplesWhereNoiseIs) {
    const Picture picture = finished(format_of(0.03f), 16).picture();
    EXPECT_EQ(picture.samples.at(0), 64) << "no noise: as few as allowed";
    EXPECT_GT(picture.samples.at(width - 1), picture.samples.at(12));
    EXPECT_LE(*std::max_element(picture.samples.begin(), picture.samples.end()), samples);
    for (std::uint32_t x = 0; x < width; ++x)
        EXPECT_EQ(picture.samples[x], picture.samples[x / cell_size * cell_size]) << "cells of one number";
}

TEST(Refinement, ReachesItsThreshold) {
    const float noise = 0.03f;  // pixels are white: relative to their brightness
    const Picture picture = finished(format_of(noise), 16).picture();
    double sum = 0;
    for (const Rgb& pixel : picture.beauty) sum += (pixel.r - 1.0) * (pixel.r - 1.0);  // two layers of 0.5
    const double squared = sum / double(picture.beauty.size());
    EXPECT_LT(squared, 1.2 * noise * noise);
    EXPECT_GT(squared, 0.2 * noise * noise) << "more samples than the threshold asks for";
}

/// A grey cell of which each sample of the first pixels lies evenly between `grey` ± `spread`, and of the others is
/// grey.
double samples_of_cell(float noise, float grey, float spread, std::uint32_t noisy = 64) {
    Film film({8, 8, {"all"}, 1 << 16, {}, {noise, 32}});
    std::mt19937 random(1);
    const auto render = [&](const Tile& tile) {
        std::vector<Rgb> pixels;
        for (std::uint32_t i = 0; i < tile.pixels(); ++i) {
            float sum = 0;
            for (std::uint32_t s = 0; s < tile.samples; ++s)
                sum += grey + (i < noisy ? spread * (float(random() >> 8) * 0x2p-24f - 1) : 0);
            pixels.push_back({sum, sum, sum});
        }
        return pixels;
    };
    const auto first = tiles_of(film.format(), 8);
    for (std::deque<Tile> wanted(first.begin(), first.end()); !wanted.empty(); wanted.pop_front()) {
        film.add(wanted.front(), render(wanted.front()));
        for (const Tile& more : film.more(wanted.front())) wanted.push_back(more);
    }
    return film.mean_samples();
}

// By hand: of n samples each channel has the deviation spread / √(3n), and the mean of its estimates, k blocks, lies
// below by about 1 / 4k. Three channels are compared with √(3 grey), or with 3 grey where that is more than 1.
TEST(Refinement, ComparesNoiseWithTheRootOfTheBrightness) {
    const auto wanted = [](double noise, double spread, double scale) {
        return std::pow(3 * spread / (noise * scale), 2) / 3;
    };
    EXPECT_NEAR(samples_of_cell(0.01f, 0.03f, 0.03f) / wanted(0.01, 0.03, std::sqrt(0.09)), 1, 0.06);
    EXPECT_NEAR(samples_of_cell(0.004f, 0.12f, 0.03f) / wanted(0.004, 0.03, std::sqrt(0.36)), 1, 0.06);
    EXPECT_NEAR(samples_of_cell(0.01f, 2, 1) / wanted(0.01, 1, 6), 1, 0.06);
}

// An eighth of them, with eight times what they may have. By their mean square they would need eight times as many.
TEST(Refinement, IsHeldByFewPixelsAsFarAsTheyCount) {
    const double few = samples_of_cell(0.00125f, 0.12f, 0.12f, 8), all = samples_of_cell(0.01f, 0.12f, 0.12f);
    EXPECT_NEAR(few / all, 1, 0.2);
}

TEST(Refinement, TakesFewerSamplesThanAnEvenSpreadOfTheSameError) {
    const auto error_of = [](const Picture& picture) {
        double sum = 0;
        for (const Rgb& pixel : picture.beauty) sum += (pixel.r - 1.0) * (pixel.r - 1.0);
        return sum / double(picture.beauty.size());
    };
    const Film film = finished(format_of(0.03f), 16);
    auto even = format_of(0);
    even.samples = static_cast<std::uint32_t>(film.mean_samples()) / 16 * 16 + 16;
    EXPECT_LT(error_of(film.picture()), error_of(finished(even, 16).picture()));
}

TEST(Refinement, NeedsNoMoreThanAllSamples) {
    const Picture picture = finished(format_of(1e-6f), 16).picture();
    EXPECT_EQ(picture.samples.at(0), 64);
    EXPECT_EQ(picture.samples.at(width - 1), samples);
    Film all(format_of(0));
    for (const Tile& tile : tiles_of(format_of(0), 16))
        for (const Tile& block : one_by_one(tile)) all.add(block, rendered(block));
    EXPECT_NEAR(picture.beauty.back().r, all.picture().beauty.back().r, 1e-6) << "but for the order of sums";
    EXPECT_TRUE(all.picture().samples.empty());
}

// Takes tiles as they are wanted, `most` of them.
void render(Film& film, std::deque<Tile> wanted, std::size_t most) {
    for (; !wanted.empty() && most > 0; wanted.pop_front(), --most) {
        film.add(wanted.front(), rendered(wanted.front()));
        for (const Tile& more : film.more(wanted.front())) wanted.push_back(more);
    }
}

TEST(Refinement, GoesOnWhereAnotherRunEnded) {
    const auto format = format_of(0.03f);
    const Picture picture = finished(format, 16).picture();
    const auto all = tiles_of(format, 16);
    for (const std::size_t done : {0u, 3u, 20u, 30u, 60u}) {
        Film ended(format), film(format);
        render(ended, {all.begin(), all.end()}, done);
        film.restore(ended.state());
        std::deque<Tile> wanted;
        for (const Tile& tile : all)
            if (!film.has(tile)) wanted.push_back(tile);
        for (const Tile& tile : film.going_on()) wanted.push_back(tile);
        render(film, wanted, 1000000);
        EXPECT_TRUE(film.complete());
        EXPECT_TRUE(film.picture() == picture) << done;
    }
}

TEST(Refinement, RefusesTilesThatCutCells) {
    Film film(format_of(0.1f));
    EXPECT_THROW(film.add({0, 0, 11, 8, 0, 16}, std::vector<Rgb>(2 * 11 * 8)), Error);
    EXPECT_THROW(film.add({4, 0, 8, 8, 0, 16}, std::vector<Rgb>(2 * 8 * 8)), Error);
}

TEST(Crop, HasThePixelsOfTheWholePicture) {
    for (const float noise : {0.0f, 0.03f}) {
        const Picture whole = finished(format_of(noise), 16).picture();
        for (const Window& window : {Window{0, 0, 37, 21}, Window{5, 3, 20, 10}, Window{36, 20, 1, 1}}) {
            const Picture part = finished(format_of(noise, window), 7).picture();
            ASSERT_EQ(part.width, window.width);
            ASSERT_EQ(part.height, window.height);
            EXPECT_EQ(part.x, window.x);
            EXPECT_EQ(part.whole_height, height);
            for (std::uint32_t i = 0; i < window.pixels(); ++i) {
                const auto j = (window.y + i / window.width) * width + window.x + i % window.width;
                EXPECT_EQ(part.beauty[i], whole.beauty[j]);
                EXPECT_EQ(part.layers[1].pixels[i], whole.layers[1].pixels[j]);
                ASSERT_EQ(part.samples.empty(), noise == 0);
                if (!part.samples.empty()) {
                    EXPECT_EQ(part.samples[i], whole.samples[j]);
                }
            }
        }
    }
}

TEST(Crop, MustLieInsideOfThePicture) {
    for (const Window& window : {Window{0, 0, 38, 1}, Window{37, 0, 1, 1}, Window{3, 3, 0, 1}, Window{0, 20, 1, 2}})
        EXPECT_THROW(Film(format_of(0, window)), Error);
}

TEST(Preview, SaysHowMuchOfItIsDone) {
    Film film(format_of(0));
    const auto tiles = tiles_of(format_of(0), 64);
    film.add(tiles[0], rendered(tiles[0]));
    EXPECT_FLOAT_EQ(film.picture().done, 1.0f / 40);
    EXPECT_EQ(film.mean_samples(), 16);
    EXPECT_EQ(finished(format_of(0), 64).picture().done, 1);
}

}  // namespace
}  // namespace lightnet::refinement_test
