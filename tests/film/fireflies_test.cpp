// Fireflies are counted where few pixels hold the error, and nowhere else.
#include <gtest/gtest.h>

#include "core/base/math/samples.hpp"
#include "core/film/fireflies.hpp"

namespace lightnet::fireflies_test {
namespace {

constexpr std::uint32_t side = 64;

// Evenly lit from the left to the right, and as noisy as said.
Picture noisy(float noise) {
    Picture picture;
    picture.width = picture.height = side;
    PictureLayer layer;
    layer.name = "bounce";
    for (std::uint32_t i = 0; i < side * side; ++i) {
        const float u = Samples(5, i).next(), light = (0.2f + float(i % side) / side) * (1 + noise * (u - 0.5f));
        layer.pixels.push_back({light, light, light});
    }
    picture.layers.push_back(layer);
    return picture;
}
std::optional<Fireflies> found_in(const Picture& picture) { return fireflies_in(picture, {&picture.layers[0]}); }

TEST(Fireflies, AreCountedAndNamedTheBrightestFirst) {
    Picture picture = noisy(0.2f);
    picture.x = 100, picture.y = 50;
    auto& pixels = picture.layers[0].pixels;
    for (std::uint32_t i = 0; i < 7; ++i) pixels[(5 + 8 * i) * side + 20 + i] = {100.0f + float(i), 100, 100};
    pixels[40 * side + 50] = {300, 300, 300};
    const auto found = found_in(picture);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->pixels, 8u);
    ASSERT_EQ(found->brightest.size(), 3u);
    for (const auto& place : found->brightest) {
        const auto& pixel = pixels[(place.y - 50) * side + place.x - 100];
        EXPECT_GE(pixel.r, 100);
    }
}

TEST(Fireflies, AreNotWhatIsNoisyAllOver) {
    EXPECT_FALSE(found_in(noisy(0)));
    EXPECT_FALSE(found_in(noisy(0.5f)));
    EXPECT_FALSE(found_in(noisy(1.9f)));
    Picture sprinkled = noisy(0.2f);
    for (std::uint32_t i = 0; i < side * side; i += 13) sprinkled.layers[0].pixels[i] = {100, 100, 100};
    EXPECT_FALSE(found_in(sprinkled)) << "a picture that needs more samples everywhere";
}

TEST(Fireflies, AreNotEdgesAndNotInTheDark) {
    Picture edge = noisy(0.1f);
    for (std::uint32_t i = 0; i < side * side; ++i)
        if (i % side > 30) edge.layers[0].pixels[i] = {50, 50, 50};
    EXPECT_FALSE(found_in(edge));
    Picture dim = noisy(0);
    for (Rgb& pixel : dim.layers[0].pixels) pixel = {};
    dim.layers[0].pixels[20 * side + 20] = {0.1f, 0.1f, 0.1f};
    EXPECT_FALSE(found_in(dim));
    EXPECT_FALSE(fireflies_in(Picture{}, {}));
}

}  // namespace
}  // namespace lightnet::fireflies_test
