// A film of more samples goes on from one of fewer, to the bytes that it would have had at once.
#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <limits>
#include <map>
#include <optional>
#include <random>
#include <set>

#include "core/base/error.hpp"
#include "core/film/film.hpp"

namespace lightnet::more_samples_test {
namespace {

constexpr std::uint32_t width = 9, height = 7;

FilmFormat format_of(std::uint32_t samples, float error = 0) {
    return {width, height, {"emission", "direct"}, samples, {}, {error, 64}};
}

Rgb sample(std::uint32_t x, std::uint32_t y, std::uint32_t index, std::uint32_t layer) {
    std::minstd_rand random(((y * 64 + x) * 8192 + index) * 4 + layer + 1);
    random.discard(2);
    const float bright = 0.5f + float(x) / width * (float(random() % 2000) / 1000 - 1);
    return {bright, 0.3f * bright, 1e-3f + bright};
}

// What a place answers: each block's samples added up, then the blocks.
std::vector<Rgb> rendered(const Tile& tile) {
    std::vector<Rgb> pixels(tile.pixels() * 2);
    for (const Tile& block : one_by_one(tile)) {
        auto next = pixels.begin();
        for (std::uint32_t y = tile.y; y < tile.y + tile.height; ++y)
            for (std::uint32_t x = tile.x; x < tile.x + tile.width; ++x)
                for (std::uint32_t layer = 0; layer < 2; ++layer, ++next) {
                    Rgb sum;
                    for (std::uint32_t i = 0; i < block.samples; ++i)
                        sum += sample(x, y, block.first_sample + i, layer);
                    *next = block.block() == tile.block() ? sum : *next + sum;
                }
    }
    return pixels;
}

struct Work {
    std::uint64_t blocks = 0;  // of tiles
};

// Adds what the film lacks, in the way of a run.
Work finish(Film& film, const FilmFormat& format, unsigned seed) {
    Work work;
    std::deque<Tile> wanted;
    for (const Tile& tile : tiles_of(format, 5))
        for (const Tile& lacking : film.lacking(tile)) {
            const auto blocks = one_by_one(lacking);
            const bool apart = seed % 2;
            wanted.insert(wanted.end(), apart ? blocks.begin() : blocks.end(), blocks.end());
            if (!apart) wanted.push_back(lacking);
        }
    for (const Tile& tile : film.going_on()) wanted.push_back(tile);
    std::shuffle(wanted.begin(), wanted.end(), std::mt19937(seed));
    while (!wanted.empty()) {
        const Tile tile = wanted.front();
        wanted.pop_front();
        film.add(tile, rendered(tile));
        work.blocks += tile.blocks() * tile.pixels();
        for (const Tile& more : film.more(tile)) wanted.push_back(more);
    }
    EXPECT_TRUE(film.complete()) << format.samples;
    return work;
}

Picture at_once(const FilmFormat& format) {
    Film film(format);
    finish(film, format, 0);
    return film.picture();
}

const std::vector<std::uint32_t> numbers{1, 15, 16, 17, 20, 32, 40, 48, 64, 100, 112, 120, 128, 130, 256, 292, 400};

TEST(MoreSamples, GiveTheBytesThatAllOfThemGiveAtOnce) {
    std::vector<Picture> all;
    for (const auto samples : numbers) all.push_back(at_once(format_of(samples)));
    for (std::size_t few = 0; few < numbers.size(); ++few)
        for (std::size_t many = few; many < numbers.size(); ++many)
            for (const unsigned seed : {2u, 3u}) {
                const auto before = format_of(numbers[few]), after = format_of(numbers[many]);
                Film film(before), more(after);
                finish(film, before, seed);
                more.restore(film.state());
                const Work work = finish(more, after, seed);
                EXPECT_TRUE(more.picture() == all[many]) << numbers[few] << " -> " << numbers[many];
                const auto kept = many == few ? blocks_in(numbers[few]) : numbers[few] / samples_per_block;
                EXPECT_EQ(work.blocks, (blocks_in(numbers[many]) - kept) * width * height)
                    << "all whole blocks are of use: " << numbers[few] << " -> " << numbers[many];
            }
}

TEST(MoreSamples, MayBeAskedForAgainAndAgainAndInTheMiddle) {
    FilmState state = Film(format_of(20)).state();
    for (const std::uint32_t samples : {20u, 36u, 100u, 104u, 292u}) {
        Film film(format_of(samples));
        film.restore(std::move(state));
        const auto tiles = tiles_of(film.format(), 5);
        for (std::size_t i = 0; i < tiles.size(); i += 2)
            if (!film.has(tiles[i])) film.add(tiles[i], rendered(tiles[i]));
        state = film.state();
    }
    Film last(format_of(400));
    last.restore(std::move(state));
    finish(last, last.format(), 1);
    EXPECT_TRUE(last.picture() == at_once(format_of(400)));
}

TEST(MoreSamples, GiveTheSameBytesWhereCellsDecide) {
    for (const auto& [few, many] : {std::pair(20u, 200u), {32u, 300u}, {100u, 300u}, {128u, 640u}}) {
        const auto before = format_of(few, 0.05f), after = format_of(many, 0.05f);
        Film film(before), more(after);
        finish(film, before, 1);
        more.restore(film.state());
        finish(more, after, 1);
        EXPECT_TRUE(more.picture() == at_once(after)) << few << " -> " << many;
    }
}

TEST(MoreSamples, CountWhatIsNotFiniteOnce) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const FilmFormat few{1, 1, {"emission"}, 40}, many{1, 1, {"emission"}, 48};
    const std::vector<Rgb> bad{{nan, 0, 0}}, good{{1, 0, 0}};
    Film film(few), more(many);
    film.add({0, 0, 1, 1, 0, 16}, bad);
    film.add({0, 0, 1, 1, 16, 16}, good);
    film.add({0, 0, 1, 1, 32, 8}, bad);
    EXPECT_EQ(film.lost(), std::vector<std::uint64_t>{2});
    EXPECT_EQ(film.picture().beauty[0].r, 1.f / 40);
    more.restore(film.state());
    EXPECT_EQ(more.lost(), std::vector<std::uint64_t>{1}) << "its last block is rendered anew, as a whole";
    more.add({0, 0, 1, 1, 32, 16}, bad);
    EXPECT_EQ(more.lost(), std::vector<std::uint64_t>{2});
    Film still_more({1, 1, {"emission"}, 64});
    still_more.restore(more.state());
    still_more.add({0, 0, 1, 1, 48, 16}, good);
    EXPECT_TRUE(still_more.complete());
    EXPECT_EQ(still_more.lost(), std::vector<std::uint64_t>{2});
    EXPECT_EQ(still_more.picture().beauty[0].r, 2.f / 64);
}

TEST(MoreSamples, AreNoFewer) { EXPECT_THROW(Film(format_of(64)).restore(Film(format_of(80)).state()), Error); }

TEST(MoreSamples, AFilmThatEndsEarlyIsThatOfAsManySamplesAsItHas) {
    const FilmFormat all = format_of(292);
    for (std::uint32_t blocks = 1; blocks < 19; ++blocks) {
        Film film(all);
        for (const Tile& tile : tiles_of(all, 5))
            for (const Tile& block : one_by_one(tile))
                if (block.block() < blocks) film.add(block, rendered(block));
        ASSERT_EQ(film.even_samples(), blocks * samples_per_block);
        const auto expected_now = film.picture();
        film = film.of_samples(blocks * samples_per_block);
        EXPECT_TRUE(film.complete());
        const FilmFormat fewer = format_of(blocks * samples_per_block);
        Film expected(fewer), more(all), at_once(all);
        finish(expected, fewer, 0);
        EXPECT_TRUE(film.picture() == expected.picture()) << blocks;
        EXPECT_TRUE(expected_now.layers == expected.picture().layers) << "as it was before: " << blocks;
        EXPECT_TRUE(expected_now.samples.empty());
        more.restore(film.state());
        finish(more, all, blocks);
        finish(at_once, all, 0);
        EXPECT_TRUE(more.picture() == at_once.picture()) << blocks;
    }
}

TEST(MoreSamples, AFilmEndsEarlyOnlyWhereAllPixelsHaveAsMany) {
    const FilmFormat all = format_of(64);
    Film film(all);
    EXPECT_EQ(film.even_samples(), std::nullopt) << "it has none";
    const auto tiles = tiles_of(all, 5);
    film.add(tiles[0], rendered(tiles[0]));
    EXPECT_EQ(film.even_samples(), std::nullopt);
    EXPECT_EQ(film.samples_begun(), 16u);
    EXPECT_THROW(film.of_samples(8), Error);
    for (const Tile& tile : tiles)
        if (tile.block() == 0) film.add(tile, rendered(tile));
    EXPECT_EQ(film.even_samples(), 16u);
    const auto far = std::find_if(tiles.begin(), tiles.end(), [](const Tile& tile) { return tile.block() == 2; });
    film.add(*far, rendered(*far));
    EXPECT_EQ(film.even_samples(), std::nullopt) << "something waits";
    EXPECT_EQ(film.samples_begun(), 64u);
}

// Each pixel of a film that is not complete shows what a picture of as many samples as it has shows there.
TEST(MoreSamples, AnIncompleteFilmShowsTheBlocksOfEachPixelAndSaysHowMany) {
    const FilmFormat all = format_of(292);
    Film film(all);
    std::uint32_t blocks = 0;
    std::map<std::uint32_t, Picture> expected;
    for (Tile tile : tiles_of(all, 2)) {
        if (tile.block() > 0) break;
        for (std::uint32_t block = 0; block < blocks; ++block) {
            tile.first_sample = block * samples_per_block, tile.samples = samples_of(block, all.samples);
            film.add(tile, rendered(tile));
        }
        const auto samples = std::min(blocks * samples_per_block, all.samples);
        if (samples > 0 && !expected.contains(samples)) {
            Film whole(format_of(samples));
            finish(whole, format_of(samples), 0);
            expected.emplace(samples, whole.picture());
        }
        blocks = (blocks + 1) % 20;
    }
    const Picture picture = film.picture();
    ASSERT_EQ(picture.samples.size(), picture.layers[0].pixels.size());
    std::set<float> seen;
    for (std::size_t i = 0; i < picture.samples.size(); ++i) {
        seen.insert(picture.samples[i]);
        const auto samples = static_cast<std::uint32_t>(picture.samples[i]);
        const Rgb wanted = samples ? expected.at(samples).layers[0].pixels[i] : Rgb{};
        ASSERT_EQ(picture.layers[0].pixels[i], wanted) << i << ": " << samples;
    }
    EXPECT_GT(seen.size(), 1u);
    EXPECT_LT(picture.done, 1);
}

TEST(MoreSamples, AFilmGoesOnFromAShortLastBlockWithoutIt) {
    for (const std::uint32_t few : {1u, 13u, 33u, 72u, 145u}) {
        Film film(format_of(few)), expected(format_of(292));
        finish(film, format_of(few), 0);
        Film more = film.of_samples(292);
        EXPECT_EQ(more.samples_begun(), few / samples_per_block * samples_per_block);
        finish(more, format_of(292), few / samples_per_block);
        finish(expected, format_of(292), 0);
        EXPECT_TRUE(more.picture() == expected.picture()) << few;
    }
}

}  // namespace
}  // namespace lightnet::more_samples_test
