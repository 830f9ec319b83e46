// Layers that are there before a picture is rendered, and the film that they are put into.
#include "tools/session/known_lights.hpp"

#include <gtest/gtest.h>

#include <random>

namespace lightnet::known_lights_test {
namespace {

constexpr std::uint32_t tile_size = 4;

FilmFormat format_of(std::uint32_t samples) {
    FilmFormat format;
    format.width = 7, format.height = 5;
    format.layers = {"emission", "a", "b"};
    format.samples = samples;
    return format;
}

// Of all samples; what is left out is black.
Film film_of(const FilmFormat& format, std::size_t left_out = 99, const KnownLights* shown = nullptr) {
    Film film(format);
    std::mt19937 random(7);
    std::uniform_real_distribution<float> light(0, 3);
    for (const Tile& tile : tiles_of(format, tile_size)) {
        std::vector<Rgb> pixels(tile.told() * format.colours());
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            const Rgb colour{light(random), light(random), light(random)};
            if (i % format.colours() != left_out) pixels[i] = colour;
        }
        film.add(tile, shown ? shown->shown_in(tile, pixels) : pixels);
    }
    return film;
}

LightRecipe recipe_of(std::size_t layer) { return {{0, {layer}, {}, {}}, {layer}, {}}; }

FilmState part_of(const Film& film, std::size_t layer) {
    return colours_of(film.state(), std::vector{layer}, film.format().colours());
}

class Samples : public testing::TestWithParam<std::uint32_t> {};

TEST_P(Samples, OfAFilmAreAsIfAllHadBeenRendered) {
    const FilmFormat format = format_of(GetParam());
    const Film whole = film_of(format);
    KnownLights known(format, {});
    ASSERT_TRUE(known.add(recipe_of(1), part_of(whole, 1)));
    EXPECT_EQ(known.names(), std::vector<std::string>{"a"});
    Film film = film_of(format, 1, &known);
    EXPECT_TRUE(known.are_shown());
    known.complete(film);
    EXPECT_FALSE(known.are_shown());
    EXPECT_EQ(film.state(), whole.state());
}

TEST_P(Samples, OfALayerAreShownFromTheFirstOnAboutAsTheyAre) {
    const FilmFormat format = format_of(GetParam());
    const Film whole = film_of(format);
    KnownLights known(format, {});
    ASSERT_TRUE(known.add(recipe_of(1), part_of(whole, 1)));
    const Picture shown = film_of(format, 1, &known).picture(), there = whole.picture();
    for (std::size_t i = 0; i < there.layers[1].pixels.size(); ++i)
        EXPECT_NEAR(shown.layers[1].pixels[i].r, there.layers[1].pixels[i].r, 1e-4f);
}

TEST(KnownLights, AreShownInACoarseLook) {
    const FilmFormat format = format_of(16);
    const Film whole = film_of(format);
    KnownLights known(format, {});
    ASSERT_TRUE(known.add(recipe_of(1), part_of(whole, 1)));
    const Picture shown = film_of(coarse_look(format), 1, &known).picture(), there = whole.picture();
    for (std::uint32_t y = 0; y < format.height; ++y)
        for (std::uint32_t x = 0; x < format.width; ++x)
            EXPECT_NEAR(shown.layers[1].pixels[y * format.width + x].r,
                        there.layers[1].pixels[y / 2 * 2 * format.width + x / 2 * 2].r, 1e-4f);
}

INSTANTIATE_TEST_SUITE_P(Groups, Samples, testing::Values(1, 16, 24, 64, 200));

TEST(KnownLights, HaveAllSamplesThatAreWanted) {
    KnownLights known(format_of(32), {});
    EXPECT_FALSE(known.add(recipe_of(1), part_of(film_of(format_of(16)), 1)));
    EXPECT_FALSE(known.add(recipe_of(1), part_of(film_of(format_of(64)), 1)));
    EXPECT_FALSE(known.add(recipe_of(1), part_of(Film(format_of(32)), 1))) << "nothing is there";
    EXPECT_TRUE(known.empty());
}

TEST(KnownLights, AreOfAFilmOfThatSize) {
    FilmFormat other = format_of(16);
    other.width = 9;
    KnownLights known(format_of(16), {});
    EXPECT_FALSE(known.add(recipe_of(1), part_of(film_of(other), 1)));
}

}  // namespace
}  // namespace lightnet::known_lights_test
