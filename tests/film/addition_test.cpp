// Ids of pixels are counted, whatever the film does with its tiles.
#include "core/film/addition.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "core/base/error.hpp"
#include "core/film/film.hpp"
#include "tests/film/pictures.hpp"

namespace lightnet::addition_test {
namespace {

using testing::ElementsAre;

TEST(Ids, AreCountedByTheirBits) {
    std::vector<Rgb> ids(4);
    add_ids(ids, std::vector{seen_id(7), seen_id(-3)});
    add_ids(ids, std::vector{seen_id(-3, 4), Rgb{}});
    EXPECT_THAT(ids, ElementsAre(seen_id(-3, 5), seen_id(7), Rgb{}, Rgb{}));
}

TEST(Ids, ThatAreSeenEquallyOftenStandInTheOrderOfTheirBits) {
    const std::vector<Rgb> seen{seen_id(2), seen_id(-1), seen_id(1)};
    std::vector<Rgb> forward(3), backward(3);
    for (std::size_t i = 0; i < 3; ++i) {
        add_ids(forward, {&seen[i], 1});
        add_ids(backward, {&seen[2 - i], 1});
    }
    EXPECT_THAT(forward, ElementsAre(seen_id(1), seen_id(2), seen_id(-1)));
    EXPECT_EQ(forward, backward);
}

TEST(Ids, ThatAreTooManyLoseThoseThatAreSeenLeast) {
    std::vector<Rgb> ids(2);
    add_ids(ids, std::vector{seen_id(1, 3), seen_id(2, 1)});
    add_ids(ids, std::vector{seen_id(3, 2)});
    EXPECT_THAT(ids, ElementsAre(seen_id(1, 3), seen_id(3, 2)));
}

// Two layers, a fact, ids and alpha: columns of both kinds, in a picture whose last group is open.
FilmFormat mixed_format(std::uint32_t samples) {
    FilmFormat format{13, 9, {"emission", "direct"}, samples};
    format.shown = {"depth", "things"};
    format.facts = {"depth", "things"};
    format.ids = {{"things", 4}};
    format.alpha = true;
    return format;
}

// As a renderer would: what a block has depends on pixel and block alone. Few of many names are seen in each.
std::vector<Rgb> rendered(const FilmFormat& format, const Tile& tile) {
    const std::size_t colours = format.colours();
    std::vector<Rgb> sums(tile.pixels() * colours);
    for (const Tile& block : one_by_one(tile)) {
        std::vector<Rgb> part(sums.size());
        for (std::size_t i = 0; i < tile.pixels(); ++i) {
            const auto x = tile.x + std::uint32_t(i % tile.width), y = tile.y + std::uint32_t(i / tile.width);
            std::mt19937 random((y * 64 + x) * 256 + block.block());
            const auto light = noise(3, random());
            std::copy(light.begin(), light.end(), part.begin() + std::ptrdiff_t(i * colours));
            for (std::uint32_t s = 0; s < block.samples; ++s) {
                const Rgb id = seen_id(float(1 + random() % 9));
                add_ids(std::span(part).subspan(i * colours + 3, 4), {&id, 1});
            }
            part[i * colours + 7] = Rgb{1, 1, 1} * float(block.samples / 2);
        }
        format.addition()(sums, part);
    }
    return sums;
}

Picture made_of(const FilmFormat& format, const std::vector<Tile>& tiles) {
    Film film(format);
    for (const Tile& tile : tiles) film.add(tile, rendered(format, tile));
    EXPECT_TRUE(film.complete());
    return film.picture(2);
}

TEST(Ids, AreSeenWhileThePictureGrowsInAColourOfTheirOwn) {
    const Rgb ball[] = {seen_id(7, 4)}, other[] = {seen_id(8, 4)}, both[] = {seen_id(7, 2), seen_id(8, 2)};
    const Rgb colour = false_colour(ball, 4);
    EXPECT_EQ(false_colour(ball, 4), colour);
    EXPECT_FALSE(false_colour(other, 4) == colour);
    for (const float channel : {colour.r, colour.g, colour.b}) {
        EXPECT_GE(channel, 0);
        EXPECT_LE(channel, 1);
    }
    EXPECT_EQ(false_colour(ball, 8), colour * 0.5f) << "the rest sees none";
    EXPECT_EQ(false_colour(both, 4), colour * 0.5f + false_colour(other, 4) * 0.5f);
    EXPECT_EQ(false_colour(std::vector<Rgb>(4), 4), Rgb{});

    const FilmFormat format = mixed_format(16);
    Film film(format);
    const auto tile = tiles_of(format, 8).front();
    film.add(tile, rendered(format, tile));
    const auto picture = film.picture();
    const auto views = format.views();
    const auto seen = film.so_far(tile);
    ASSERT_EQ(views.size(), 5u);
    EXPECT_EQ(format.name_of(views[3]), "things");
    EXPECT_EQ(seen[4], (Rgb{0.5f, 0.5f, 0.5f})) << "half of the pixel is covered";
    const auto& ids = picture.mattes.at(0);
    Rgb expected;
    for (std::uint32_t rank = 0; rank < ids.ranks; ++rank) {
        const Rgb id[] = {seen_id(ids.pixels[rank].id, ids.pixels[rank].part)};
        expected += false_colour(id, 1);
    }
    EXPECT_NEAR(seen[3].r, expected.r, 1e-5f);
    EXPECT_NEAR(seen[3].g, expected.g, 1e-5f);
    EXPECT_NEAR(seen[3].b, expected.b, 1e-5f);
}

TEST(Ids, AreTheSameInWhateverOrderAndPiecesTilesCome) {
    const FilmFormat format = mixed_format(292);
    auto tiles = tiles_of(format, 8);
    const Picture expected = made_of(format, tiles);
    ASSERT_EQ(expected.mattes.size(), 1u);
    std::mt19937 random(3);
    for (int turn = 0; turn < 5; ++turn) {
        std::shuffle(tiles.begin(), tiles.end(), random);
        std::vector<Tile> pieces;
        for (const Tile& tile : tiles)
            if (random() % 2)
                pieces.push_back(tile);
            else
                for (const Tile& block : one_by_one(tile)) pieces.push_back(block);
        EXPECT_TRUE(made_of(format, pieces) == expected);
    }
    EXPECT_TRUE(made_of(format, tiles_of(format, 3)) == expected) << "tiles of another size";
}

TEST(Ids, AreTheSameWhereAFilmIsTakenUpAgainAndWherePixelsGetMoreSamples) {
    for (const std::uint32_t samples : {100u, 160u, 292u}) {
        const FilmFormat less = mixed_format(100), all = mixed_format(samples);
        Film first(less);
        const auto some = tiles_of(less, 8);
        for (std::size_t i = 0; i < some.size(); i += 2) first.add(some[i], rendered(less, some[i]));
        Film second(all);
        second.restore(first.state());
        for (const Tile& tile : tiles_of(all, 8))
            for (const Tile& lacking : second.lacking(tile)) second.add(lacking, rendered(all, lacking));
        ASSERT_TRUE(second.complete());
        EXPECT_TRUE(second.picture(2) == made_of(all, tiles_of(all, 8))) << samples;
    }
}

TEST(Ids, AreTheSameWhereCellsDecideAboutTheirSamples) {
    FilmFormat format = mixed_format(128);
    format.refinement = {0.9f, 32};
    std::vector<Picture> pictures;
    for (const std::uint32_t size : {8u, 16u}) {
        Film film(format);
        auto tiles = tiles_of(format, size);
        for (std::size_t i = 0; i < tiles.size(); ++i) {
            film.add(tiles[i], rendered(format, tiles[i]));
            const auto more = film.more(tiles[i]);
            tiles.insert(tiles.end(), more.begin(), more.end());
        }
        ASSERT_TRUE(film.complete());
        pictures.push_back(film.picture());
    }
    EXPECT_TRUE(pictures[0] == pictures[1]);
    const auto& matte = pictures[0].mattes[0];
    for (std::size_t i = 0; i < matte.pixels.size(); i += 4) EXPECT_LE(matte.pixels[i].part, 1);
}

TEST(Ids, HaveLayersWhoseNamesNoOtherMayHave) {
    FilmFormat format = mixed_format(16);
    format.shown.push_back("things01");
    try {
        const Film film(format);
        FAIL();
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("a layer is called 'things01', as one of the matte 'things'"));
    }
}

TEST(Ids, CoverAsMuchOfAPixelAsTheyAreSeenIn) {
    FilmFormat format = mixed_format(40);
    format.width = format.height = 1;
    std::vector<Rgb> pixel(format.colours());
    const auto block = [&](float first, float second) {
        pixel[3] = seen_id(11, first);
        pixel[4] = second > 0 ? seen_id(12, second) : Rgb{};
        return pixel;
    };
    Film film(format);
    film.add({0, 0, 1, 1, 0, 16}, block(16, 0));
    film.add({0, 0, 1, 1, 16, 16}, block(4, 8));
    film.add({0, 0, 1, 1, 32, 8}, block(0, 2));
    const auto seen = film.picture().mattes.at(0);
    EXPECT_EQ(seen.pixels[0], (Covered{11, 20.f / 40}));
    EXPECT_EQ(seen.pixels[1], (Covered{12, 10.f / 40}));
    EXPECT_EQ(seen.pixels[2], Covered{});
}

}  // namespace
}  // namespace lightnet::addition_test
