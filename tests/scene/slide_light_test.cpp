// Spots that throw pictures.
#include "core/scene/bare_lights/slide_light.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/math/samples.hpp"
#include "core/base/math/sampling.hpp"
#include "core/scene/bare_lights/bare_light.hpp"

namespace lightnet::slide_light_test {
namespace {

/// Red, green over blue, white; three times as wide as high at distance 1, seen along +x with the picture's right at
/// -y.
SpotLight four_pixels() {
    SpotLight light;
    light.position = {1, 2, 3}, light.axis = {1, 0, 0}, light.intensity = {2, 2, 2};
    light.inner = light.outer = 1.2f;
    Slide slide;
    slide.image = std::make_shared<const Image>(2, 2, std::vector<Rgb>{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}});
    slide.to_world.m = {{{0, 0, 1, 0}, {-1, 0, 0, 0}, {0, -1, 0, 0}, {0, 0, 0, 1}}};
    slide.half_width = 0.9f, slide.half_height = 0.3f;
    light.slide = slide;
    return light;
}

Rgb through(const SlideLight& light, float right, float down) { return light.towards(normalize({1, -right, -down})); }

TEST(SlideLight, ThrowsItsPicture) {
    const SlideLight light(four_pixels());
    EXPECT_NEAR(through(light, -0.45f, -0.15f).r, 2, 1e-5f);
    EXPECT_NEAR(through(light, -0.45f, -0.15f).g, 0, 1e-5f);
    EXPECT_NEAR(through(light, 0.45f, -0.15f).g, 2, 1e-5f);
    EXPECT_NEAR(through(light, -0.45f, 0.15f).b, 2, 1e-5f);
    EXPECT_NEAR(through(light, 0.45f, 0.15f).r, 2, 1e-5f);
    EXPECT_NEAR(through(light, 0, 0).r, 1, 1e-5f);
    EXPECT_NEAR(through(light, -0.89f, -0.29f).r, 2, 1e-5f);
    for (const Rgb beside : {through(light, 0.91f, 0), through(light, 0, -0.31f), light.towards({-1, 0, 0})})
        EXPECT_TRUE(is_black(beside));
}

TEST(SlideLight, LightsPlanesEvenlyWhereItSaysSo) {
    SpotLight spot = four_pixels();
    spot.slide->image = std::make_shared<const Image>(1, 1, std::vector<Rgb>{{1, 1, 1}});
    spot.slide->even_on_planes = true;
    const SlideLight light(spot);
    for (const float right : {0.0f, 0.4f, 0.85f}) {
        const float cosine = 1 / std::sqrt(1 + right * right + 0.01f);
        EXPECT_NEAR(through(light, right, 0.1f).g * cosine * cosine * cosine, 2, 1e-4f);
    }
    EXPECT_NEAR(light.power().g, 2 * 1.8f * 0.6f, 1e-4f);
}

TEST(SlideLight, FallsOffAsItsSpotDoes) {
    SpotLight spot = four_pixels();
    spot.inner = 0.1f, spot.outer = 0.25f, spot.falloff = SpotLight::Falloff::linear;
    spot.slide->image = std::make_shared<const Image>(1, 1, std::vector<Rgb>{{1, 0.5f, 1}});
    const SlideLight light(spot);
    EXPECT_NEAR(light.towards({1, 0, 0}).g, 1, 1e-5f);
    EXPECT_NEAR(light.towards({std::cos(0.175f), std::sin(0.175f), 0}).r, 1, 1e-3f);
    EXPECT_TRUE(is_black(light.towards({std::cos(0.26f), std::sin(0.26f), 0})));
}

/// A gradient with a dark half, of 16 by 8 pixels.
SpotLight gradient(bool even) {
    SpotLight light = four_pixels();
    std::vector<Rgb> pixels;
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 16; ++x) pixels.push_back(x < 8 ? Rgb{} : Rgb{float(x), float(y), 3});
    light.slide->image = std::make_shared<const Image>(16, 8, pixels);
    light.slide->even_on_planes = even;
    return light;
}

TEST(SlideLight, EmitsWhatItShows) {
    for (const bool even : {false, true}) {
        const SlideLight light(gradient(even));
        double lower = 0, upper = 0;  // halves of the picture, by quadrature
        constexpr int rows = 400, columns = 800;
        for (int i = 0; i < rows; ++i)
            for (int j = 0; j < columns; ++j) {
                const float right = (2 * (float(j) + 0.5f) / columns - 1) * 0.9f,
                            down = (2 * (float(i) + 0.5f) / rows - 1) * 0.3f;
                const double cosine = 1 / std::sqrt(1 + double{right} * right + double{down} * down);
                (down > 0 ? lower : upper) +=
                    through(light, right, down).g * cosine * cosine * cosine * 1.8 * 0.6 / rows / columns;
            }
        double sent_down = 0, sent_up = 0, squares = 0;
        constexpr std::uint32_t tries = 1 << 16;
        for (std::uint32_t i = 0; i < tries; ++i) {
            Samples samples(4, i);
            const Emission sent = light.emission(samples.next_2d());
            ASSERT_EQ(sent.origin, (Vec3{1, 2, 3}));
            (sent.direction.z < 0 ? sent_down : sent_up) += double{sent.flux.g} / tries;
            squares += double{sent.flux.g} * sent.flux.g / tries;
        }
        const double error = 4 * std::sqrt(squares / tries) + 1e-3 * (lower + upper);
        EXPECT_NEAR(sent_down, lower, error);
        EXPECT_NEAR(sent_up, upper, error);
        EXPECT_NEAR(light.power().g, lower + upper, 0.02 * (lower + upper));
    }
}

TEST(SlideLight, OfBlackSendsNothing) {
    SpotLight spot = four_pixels();
    spot.slide->image = std::make_shared<const Image>(3, 2, std::vector<Rgb>(6));
    const SlideLight light(spot);
    EXPECT_TRUE(is_black(light.power()));
    EXPECT_TRUE(is_black(light.emission({0.3f, 0.4f}).flux));
    spot.slide->image = nullptr;
    EXPECT_TRUE(is_black(SlideLight(spot).towards({1, 0, 0})));
}

}  // namespace
}  // namespace lightnet::slide_light_test
