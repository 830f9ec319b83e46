// Films as thin as light's waves.
#include <gtest/gtest.h>

#include <cmath>

#include "core/scene/bsdf/principled.hpp"
#include "core/scene/bsdf/thin_film.hpp"

namespace lightnet::thin_film_test {
namespace {

constexpr Rgb plastic{0.04f, 0.04f, 0.04f};

TEST(ThinFilm, OfNoThicknessIsNone) {
    const Rgb seen = film_reflectance({1, 1.33f, 0}, plastic, 1);
    for (const float part : {seen.r, seen.g, seen.b}) EXPECT_NEAR(part, 0.04f, 0.01f);
}

// Waves of many lengths meet in all phases: what is left are the reflections of two interfaces, one after the other.
TEST(ThinFilm, FarThickerThanWavesReflectsAsAPaneDoes) {
    const float above = 0.0200593f;  // ((1.33 - 1) / (1.33 + 1))²
    const float below = std::pow((1.5f - 1.33f) / (1.5f + 1.33f), 2.0f);
    const float both = above + (1 - above) * (1 - above) * below / (1 - above * below);
    const Rgb seen = film_reflectance({1, 1.33f, 20000}, plastic, 1);
    EXPECT_NEAR(seen.r, both, 1e-4f);
    EXPECT_NEAR(seen.g, both, 1e-4f);
    EXPECT_NEAR(seen.b, both, 1e-4f);
}

// A quarter of a wave of 550 nm: light from below, which is denser still, comes back against that from above.
TEST(ThinFilm, OfAQuarterOfAWaveTakesReflectionsAway) {
    const Rgb coated = film_reflectance({1, 1.22f, 550 / 4 / 1.22f}, plastic, 1);
    EXPECT_LT(coated.g, 0.004f);
    const Rgb doubled = film_reflectance({1, 1.22f, 550 / 2 / 1.22f}, plastic, 1);
    EXPECT_GT(doubled.g, 0.025f);
}

TEST(ThinFilm, IsNowhereAboveItsCeiling) {
    for (const float thickness : {80.0f, 250.0f, 400.0f, 900.0f})
        for (const float base : {0.0f, 0.04f, 0.3f, 0.9f}) {
            const ThinFilm film{1, 1.4f, thickness};
            const Rgb below{base, base / 2, base};
            const float ceiling = film_ceiling(film, below);
            for (int i = 0; i <= 1000; ++i) {
                const float cosine = float(i) / 1000;
                const Rgb seen = film_reflectance(film, below, cosine);
                EXPECT_LE(max_component(seen), schlick(ceiling, 1, cosine) + 1e-3f) << cosine;
                EXPECT_GE(std::min({seen.r, seen.g, seen.b}), 0);
            }
        }
}

TEST(ThinFilm, ReflectsAllWhereNothingEntersIt) {
    EXPECT_EQ(film_reflectance({1, 0.8f, 300}, plastic, 0.1f), (Rgb{1, 1, 1}));
}

}  // namespace
}  // namespace lightnet::thin_film_test
