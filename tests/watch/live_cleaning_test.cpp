#include "tools/watch/live_cleaning.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <random>
#include <thread>

#include "core/film/clean/clean.hpp"

namespace lightnet::live_cleaning_test {
namespace {

const FilmFormat format{48, 32, {"direct", "bounce"}, 32, {}, {}, {}, {"half.direct", "half.bounce"}};

std::vector<Rgb> rendered(const Tile& tile) {
    std::mt19937 random(tile.x + 64 * tile.y + tile.first_sample);
    std::vector<Rgb> pixels(tile.pixels() * 4);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const float value = float(random() % 1000) / 1000 * float(tile.samples) / (i % 4 < 2 ? 1 : 2);
        pixels[i] = {value, value, value};
    }
    return pixels;
}

void add(Film& film, std::size_t tiles) {
    const auto all = tiles_of(film.format(), 16);
    for (std::size_t i = 0; i < tiles; ++i) film.add(all[i], rendered(all[i]));
}

bool cleans(LiveCleaning& cleaning, const Film& film) {
    for (const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
         std::chrono::steady_clock::now() < end; std::this_thread::yield())
        if (cleaning.look(film)) return true;
    return false;
}

constexpr Tile corner{0, 0, 16, 16};

TEST(LiveCleaning, ShowsLayersAsTheyAreUntilAllPixelsHaveSamples) {
    Film film(format);
    LiveCleaning cleaning(format);
    add(film, 5);
    EXPECT_FALSE(cleaning.look(film));
    const auto plain = film.so_far(corner), shown = cleaning.so_far(film, corner);
    ASSERT_EQ(shown.size(), corner.pixels() * 6);
    for (std::size_t i = 0; i < corner.pixels(); ++i)
        for (std::size_t k = 0; k < 4; ++k) {
            ASSERT_EQ(shown[i * 6 + k], plain[i * 4 + k]);
            ASSERT_EQ(shown[i * 6 + 4 + k % 2], plain[i * 4 + k % 2]);
        }
}

TEST(LiveCleaning, ShowsADraftAndInTheEndWhatTheFileHas) {
    Film film(format);
    film.expose(0.5f);
    LiveCleaning cleaning(format);
    add(film, 6);
    ASSERT_TRUE(cleans(cleaning, film));
    const auto expect_shown = [&](const Picture& picture) {
        const auto shown = cleaning.so_far(film, corner);
        for (std::size_t i = 0; i < corner.pixels(); ++i)
            for (std::size_t k = 0; k < 2; ++k)
                ASSERT_EQ(shown[i * 6 + 4 + k], picture.layers[k].pixels[i / 16 * 48 + i % 16]);
    };
    expect_shown(clean(film.picture(0.5f), CleanQuality::draft).picture);
    ASSERT_TRUE(cleaning.finish(film));
    expect_shown(clean(film.picture(0.5f)).picture);
}

TEST(LiveCleaning, ForgetsAPictureThatIsBegunAnew) {
    Film film(format);
    LiveCleaning cleaning(format);
    add(film, 6);
    ASSERT_TRUE(cleaning.finish(film));
    Film other(format);
    add(other, 1);
    EXPECT_TRUE(cleaning.look(other)) << "all is other than it was";
    const auto plain = other.so_far(corner), shown = cleaning.so_far(other, corner);
    EXPECT_EQ(shown[4], plain[0]);
}

TEST(LiveCleaning, AddsNothingToAPictureThatIsNotToBeCleaned) {
    FilmFormat without = format;
    without.shown.clear();
    EXPECT_EQ(LiveCleaning(without).colours(), 0u);
    Film film(without);
    EXPECT_FALSE(LiveCleaning(without).finish(film));
}

}  // namespace
}  // namespace lightnet::live_cleaning_test
