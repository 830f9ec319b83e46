// The film gives the same bytes whatever the tiles do.
#include "core/film/film.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <random>
#include <set>

#include "core/base/error.hpp"
#include "core/network/light/renderer.hpp"
#include "tests/film/pictures.hpp"
#include "tests/support/slowdown.hpp"

namespace lightnet::film_test {
namespace {

// 19 blocks, the last one of 4 samples: groups of 1, 1, 2, 4, 8 and 3, the short block of which goes alone.
const FilmFormat format{37, 21, {"emission", "direct", "bounce"}, 292};

// Makes noise that depends on pixel, block and layer alone.
class Noise final : public Renderer {
    void render_block(const Tile& tile, std::span<Rgb> pixels) const override {
        auto next = pixels.begin();
        for (std::uint32_t y = tile.y; y < tile.y + tile.height; ++y)
            for (std::uint32_t x = tile.x; x < tile.x + tile.width; ++x)
                for (const Rgb& colour : noise(format.layers.size(), (y * 64 + x) * 32 + tile.block()))
                    *next++ = colour;
    }
};

std::vector<Rgb> rendered(const Tile& tile) {
    std::vector<Rgb> pixels(tile.pixels() * format.layers.size());
    Noise().render(tile, pixels);
    return pixels;
}

Picture picture_of(std::vector<Tile> tiles) {
    Film film(format);
    for (const Tile& tile : tiles) film.add(tile, rendered(tile));
    EXPECT_TRUE(film.complete());
    return film.picture();
}

std::vector<Tile> tiles(std::uint32_t size) { return tiles_of(format.width, format.height, size, format.samples); }

TEST(Tiles, CoverEachSampleOfEachPixelOnce) {
    for (const std::uint32_t size : {1u, 5u, 16u, 64u}) {
        std::vector<std::uint32_t> samples(format.width * format.height);
        for (const Tile& tile : tiles(size))
            for (std::uint32_t y = tile.y; y < tile.y + tile.height; ++y)
                for (std::uint32_t x = tile.x; x < tile.x + tile.width; ++x)
                    samples.at(y * format.width + x) += tile.samples;
        EXPECT_THAT(samples, ::testing::Each(format.samples));
    }
}

TEST(Tiles, AreHandedOutGroupByGroup) {
    const auto all = tiles(8);
    EXPECT_TRUE(std::is_sorted(all.begin(), all.end(),
                               [](const Tile& a, const Tile& b) { return a.first_sample < b.first_sample; }));
    EXPECT_EQ(all.size(), 7u * 5 * 3);
    std::vector<std::uint32_t> blocks;
    for (std::size_t i = 0; i < all.size(); i += 15) blocks.push_back(all[i].blocks());
    EXPECT_THAT(blocks, ::testing::ElementsAre(1, 1, 2, 4, 8, 2, 1));
}

TEST(Tiles, CanBeDoneBlockByBlock) {
    Tile last = tiles(8).back();
    last.first_sample = 256;
    last.samples = 36;
    const auto blocks = one_by_one(last);
    ASSERT_EQ(blocks.size(), 3u);
    EXPECT_EQ(blocks[0].first_sample, 256u);
    EXPECT_EQ(blocks[2].first_sample, 288u);
    EXPECT_EQ(blocks[1].samples, 16u);
    EXPECT_EQ(blocks[2].samples, 4u);
    EXPECT_EQ(blocks[2].x, last.x);
}

TEST(Tiles, AreNeighboursWhenTheyFollowEachOther) {
    const auto all = tiles_of(64, 64, 8, 1);
    for (std::size_t i = 1; i < all.size(); ++i)
        EXPECT_EQ(std::abs(int(all[i].x) - int(all[i - 1].x)) + std::abs(int(all[i].y) - int(all[i - 1].y)), 8);
}

TEST(Tiles, AreNoneForNothing) {
    EXPECT_THAT(tiles_of(0, 5, 8, 1), ::testing::IsEmpty());
    EXPECT_THAT(tiles_of(5, 5, 8, 0), ::testing::IsEmpty());
}

TEST(Film, GivesTheSameBytesInAnyOrderOfArrival) {
    const Picture in_order = picture_of(tiles(8));
    for (const unsigned seed : {1u, 2u, 3u}) {
        auto shuffled = tiles(8);
        std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(seed));
        EXPECT_TRUE(picture_of(shuffled) == in_order);
    }
    auto backwards = tiles(8);
    std::reverse(backwards.begin(), backwards.end());
    EXPECT_TRUE(picture_of(backwards) == in_order);
}

// As a launcher does when there is no time for a whole group, or when some are there already.
TEST(Film, GivesTheSameBytesWhetherGroupsComeAsAWholeOrBlockByBlock) {
    const Picture in_order = picture_of(tiles(8));
    for (const unsigned seed : {1u, 2u, 3u, 4u, 5u}) {
        std::mt19937 random(seed);
        std::vector<Tile> pieces;
        for (const Tile& tile : tiles(8)) {
            const auto blocks = one_by_one(tile);
            const auto part = random() % 3;  // nothing of it apart, all, or some and then all
            if (part > 0) pieces.insert(pieces.end(), blocks.begin() + (part == 2 && blocks.size() > 1), blocks.end());
            if (part != 1) pieces.push_back(tile);
        }
        if (seed > 1) std::shuffle(pieces.begin(), pieces.end(), random);
        EXPECT_TRUE(picture_of(pieces) == in_order) << seed;
    }
}

TEST(Film, GivesTheSameBytesForAnyTileSize) {
    const Picture by_eight = picture_of(tiles(8));
    for (const std::uint32_t size : {1u, 3u, 16u, 64u}) EXPECT_TRUE(picture_of(tiles(size)) == by_eight);
}

TEST(Film, FoldsBlocksInTheOrderOfTheirIndex) {
    // In float32 these three give 1 in the order of their index, and 0 in the opposite one.
    Film film({1, 1, {"emission"}, 48});
    const std::vector<Rgb> block[3] = {{{1e8f, 0, 0}}, {{-1e8f, 0, 0}}, {{1, 0, 0}}};
    for (const std::uint32_t b : {2u, 1u, 0u})
        film.add({0, 0, 1, 1, b * samples_per_block, samples_per_block}, block[b]);
    EXPECT_EQ(film.picture().beauty[0].r, 1.0f / 48);
}

TEST(Film, TakesTheFirstOfTwoEqualTiles) {
    Film film({1, 1, {"emission"}, 32});
    const Tile first{0, 0, 1, 1, 0, 16}, second{0, 0, 1, 1, 16, 16};
    const std::vector<Rgb> one{{1, 1, 1}}, nine{{9, 9, 9}};
    EXPECT_TRUE(film.add(second, one));
    EXPECT_FALSE(film.add(second, nine));  // while it waits for its turn
    EXPECT_TRUE(film.add(first, one));
    EXPECT_FALSE(film.add(first, nine));
    EXPECT_FALSE(film.add(second, nine));  // after it was added
    EXPECT_TRUE(film.complete());
    EXPECT_EQ(film.picture().beauty[0].r, 2.0f / 32);
}

TEST(Film, CountsWhatIsNotFiniteAsBlack) {
    Film film({2, 1, {"emission", "direct"}, 16});
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    film.add({0, 0, 2, 1, 0, 16}, std::vector<Rgb>{{16, 0, 0}, {0, nan, 1}, {0, infinity, 0}, {32, 0, 0}});
    EXPECT_THAT(film.lost(), ::testing::ElementsAre(1, 1));
    EXPECT_EQ(film.picture().beauty, (std::vector<Rgb>{{1, 0, 0}, {2, 0, 0}}));
}

// No more is lost of it than of single blocks.
TEST(Film, WantsAGroupBlockByBlockWhenItsSumIsNotFinite) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const auto pixels = [](float r) { return std::vector<Rgb>{{r, 0, 0}, {1, 0, 0}}; };
    Film film({2, 1, {"emission"}, 64});
    film.add({0, 0, 2, 1, 0, 16}, pixels(1));
    film.add({0, 0, 2, 1, 16, 16}, pixels(1));
    const Tile group{0, 0, 2, 1, 32, 32};
    EXPECT_FALSE(film.add(group, pixels(nan)));
    EXPECT_FALSE(film.has(group));
    EXPECT_EQ(film.more(group), one_by_one(group));
    EXPECT_TRUE(film.add({0, 0, 2, 1, 48, 16}, pixels(nan)));
    EXPECT_FALSE(film.complete());
    EXPECT_TRUE(film.add({0, 0, 2, 1, 32, 16}, pixels(8)));
    EXPECT_TRUE(film.complete());
    EXPECT_TRUE(film.more(group).empty());
    EXPECT_THAT(film.lost(), ::testing::ElementsAre(1));
    EXPECT_EQ(film.picture().beauty, (std::vector<Rgb>{{10.f / 64, 0, 0}, {4.f / 64, 0, 0}}));
}

TEST(Film, KeepsWhatIsShownOutOfTheSum) {
    FilmFormat one{1, 1, {"a", "b"}, 1};
    one.shown = {"seen"};
    Film film(one);
    film.add({0, 0, 1, 1, 0, 1}, std::vector<Rgb>{{1, 0, 0}, {0, 2, 0}, {0, 0, 9}});
    const Picture picture = film.picture(2);
    EXPECT_EQ(picture.beauty, (std::vector<Rgb>{{2, 4, 0}}));
    ASSERT_EQ(picture.shown.size(), 1u);
    EXPECT_EQ(picture.shown[0].pixels, (std::vector<Rgb>{{0, 0, 18}}));
    one.facts = {"seen"};
    Film facts(one);
    facts.add({0, 0, 1, 1, 0, 1}, std::vector<Rgb>{{1, 0, 0}, {0, 2, 0}, {0, 0, 9}});
    EXPECT_EQ(facts.picture(2).shown[0].pixels, (std::vector<Rgb>{{0, 0, 9}})) << "exposure is for light";
    one.shown = {"a"};
    EXPECT_THROW(Film{one}, Error) << "a name stands for one picture";
}

TEST(Film, ShowsWhatIsThereWhileItGrows) {
    Film film({2, 1, {"emission"}, 20});
    const std::vector<Rgb> sixteen{{16, 16, 16}};
    film.add({0, 0, 1, 1, 0, 16}, sixteen);
    EXPECT_FALSE(film.complete());
    EXPECT_EQ(film.done(), 0.25);
    EXPECT_EQ(film.picture().beauty, (std::vector<Rgb>{{1, 1, 1}, {0, 0, 0}}));
}

TEST(Film, ScalesEachLayerAndAddsThemUpAfterwards) {
    Film film({1, 1, {"emission", "direct"}, 1});
    film.add({0, 0, 1, 1, 0, 1}, std::vector<Rgb>{{0.1f, 1, 2}, {0.2f, 1, 2}});
    const Picture picture = film.picture(0.3f);
    EXPECT_EQ(picture.layers[0].pixels[0].r, 0.1f * 0.3f);
    EXPECT_EQ(picture.beauty[0].r, 0.1f * 0.3f + 0.2f * 0.3f);
}

TEST(Film, RefusesTilesThatAreNoneOfItsOwn) {
    Film film({8, 8, {"emission"}, 20});
    const auto refuses = [&](const Tile& tile, std::size_t colours) {
        EXPECT_THROW(film.add(tile, std::vector<Rgb>(colours)), Error);
    };
    refuses({4, 0, 8, 8, 0, 16}, 64);            // outside
    refuses({0xffffffffu, 0, 2, 8, 0, 16}, 16);  // outside, if sums did not overflow
    refuses({0, 0, 0, 8, 0, 16}, 0);             // empty
    refuses({0, 0, 8, 8, 3, 16}, 64);            // no block
    refuses({0, 0, 8, 8, 16, 16}, 64);           // more samples than the last block has
    refuses({0, 0, 8, 8, 32, 16}, 64);           // no such block
    refuses({0, 0, 8, 8, 0, 20}, 64);            // no group
    refuses({0, 0, 8, 8, 0, 16}, 63);            // a colour is missing
    film.add({0, 0, 4, 4, 0, 16}, std::vector<Rgb>(16));
    refuses({2, 2, 4, 4, 16, 4}, 16);  // of another tiling
    EXPECT_TRUE(film.add({4, 4, 4, 4, 0, 16}, std::vector<Rgb>(16)));
}

// Each block is finite, and so is each layer; their sum is not.
TEST(Film, HasNoPixelThatIsMoreThanAFloatHolds) {
    Film film({2, 1, {"a", "b"}, 32});
    const float much = 3e38f;
    const std::vector<Rgb> block{{much, 1, 1}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}};  // by pixel, then by layer
    film.add({0, 0, 2, 1, 0, 16}, block);
    film.add({0, 0, 2, 1, 16, 16}, block);
    const auto picture = film.picture();
    EXPECT_EQ(picture.overflowed, 1u);
    EXPECT_EQ(picture.beauty[0], Rgb{});
    EXPECT_EQ(picture.layers[0].pixels[0], Rgb{});
    EXPECT_EQ(picture.layers[1].pixels[0], Rgb{}) << "the layers add up to the whole";
    EXPECT_GT(picture.beauty[1].r, 0);
}

TEST(Film, ShowsOfACoarseLookWhatNeighboursShow) {
    const FilmFormat small{7, 5, {"a", "b"}, 64};
    Film film(coarse_look(small));
    for (const Tile& tile : tiles_of(film.format(), 4)) {
        std::vector<Rgb> told;
        for (std::uint32_t y = tile.y; y < tile.y + tile.height; y += coarse_stride)
            for (std::uint32_t x = tile.x; x < tile.x + tile.width; x += coarse_stride)
                for (const float layer : {1.f, 2.f}) told.push_back({float(x), float(y), layer});
        EXPECT_TRUE(film.add(tile, told));
    }
    ASSERT_TRUE(film.complete());
    const Picture picture = film.picture();
    for (std::uint32_t y = 0; y < 5; ++y)
        for (std::uint32_t x = 0; x < 7; ++x)
            for (std::size_t layer = 0; layer < 2; ++layer)
                EXPECT_EQ(picture.layers[layer].pixels[y * 7 + x],
                          (Rgb{float(x / 2 * 2), float(y / 2 * 2), float(layer + 1)}))
                    << x << ',' << y;
}

TEST(Film, RefusesToBeNothing) {
    EXPECT_THROW(Film({0, 1, {"emission"}, 1}), Error);
    EXPECT_THROW(Film({1, 1, {}, 1}), Error);
    EXPECT_THROW(Film({1, 1, {"emission"}, 0}), Error);
    EXPECT_THROW(Film({1, 1, {"emission", "emission"}, 1}), Error);
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they end the process instead
TEST(Film, SaysWhatIsTooLargeForTheMemory) {
    try {
        const Film film({1u << 22, 1u << 22, {"emission"}, 16});
        FAIL() << "200 TB were there";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), ::testing::HasSubstr("4194304x4194304 pixels of 1 layers take"));
    }
}
#endif

// What is seen of a film while it grows.
std::vector<Rgb> seen(const Film& film, const Tile& tile) {
    std::vector<Rgb> colours;
    const auto picture = film.picture(2);
    for (std::uint32_t y = tile.y; y < tile.y + tile.height; ++y)
        for (std::uint32_t x = tile.x; x < tile.x + tile.width; ++x)
            for (const auto& layer : picture.layers) colours.push_back(layer.pixels[y * picture.width + x]);
    return colours;
}

TEST(Film, ShowsOfATileWhatItsPictureWouldAtAnyTime) {
    Film film(format);
    film.expose(2);
    for (const Tile& tile : tiles(16)) {
        film.add(tile, rendered(tile));
        EXPECT_EQ(film.so_far(tile), seen(film, tile)) << tile.x << "," << tile.y << " from " << tile.first_sample;
    }
    EXPECT_TRUE(film.complete());
}

}  // namespace
}  // namespace lightnet::film_test
