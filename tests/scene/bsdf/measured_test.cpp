// Measured surfaces, by measurements whose right values are known.
#include "core/scene/bsdf/measured.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/math/samples.hpp"
#include "core/base/math/sampling.hpp"
#include "core/scene/bsdf/facets.hpp"
#include "tests/support/measured_numbers.hpp"

namespace lightnet::measured_test {
namespace {

using test::even_numbers;
using test::ggx_numbers;

TableBlend only(std::uint32_t table) { return {{table}, {1}, 1}; }

TEST(SquareDensity, ThatGrowsEvenlyIsItsSquare) {
    const SquareDensities ramp({2, 2}, {0, 1, 0, 1});  // 2x
    for (const float x : {0.1f, 0.25f, 0.5f, 0.9f}) {
        const auto found = ramp.sample({x * x, 0.3f}, only(0));
        EXPECT_NEAR(found.place.x, x, 1e-5f);
        EXPECT_NEAR(found.place.y, 0.3f, 1e-6f);
        EXPECT_NEAR(found.density, 2 * x, 1e-5f);
        EXPECT_NEAR(ramp.invert({x, 0.3f}, only(0)).place.x, x * x, 1e-5f);
    }
}

// of 2x and 2(1 - x), half each, nothing but 1 is left
TEST(SquareDensity, BetweenTablesIsTheirMean) {
    const SquareDensities ramps({2, 2}, {0, 1, 0, 1, 5, 0, 5, 0});
    const TableBlend half{{0, 1}, {0.5f, 0.5f}, 2};
    for (const float x : {0.1f, 0.7f}) {
        EXPECT_NEAR(ramps.sample({x, 0.5f}, half).place.x, x, 1e-5f);
        EXPECT_NEAR(ramps.density({x, 0.2f}, half), 1, 1e-5f);
    }
}

TEST(SquareDensity, OfNothingIsEven) {
    const SquareDensities dark({3, 2}, std::vector<float>(6));
    EXPECT_EQ(dark.density({0.3f, 0.6f}, only(0)), 1);
    EXPECT_NEAR(dark.sample({0.3f, 0.6f}, only(0)).place.x, 0.3f, 1e-6f);
}

TEST(SquareDensity, IsInvertedToWhatItWasSampledFrom) {
    const std::vector<float> hills{1, 0, 2, 5, 0, 0, 3, 1, 7, 2, 0, 4, 0, 1, 1, 6, 2, 0, 3, 3, 1, 0, 8, 1};
    const SquareDensities both({4, 3}, hills);
    const TableBlend blend{{0, 1}, {0.3f, 0.7f}, 2};
    for (std::uint32_t k = 0; k < 1000; ++k) {
        Samples samples(3, k);
        const Vec2 u = samples.next_2d();
        const auto found = both.sample(u, blend);
        const auto back = both.invert(found.place, blend);
        EXPECT_NEAR(back.place.x, u.x, 1e-4f);
        EXPECT_NEAR(back.place.y, u.y, 1e-4f);
        EXPECT_NEAR(back.density, found.density, 1e-3f * found.density + 1e-4f);
    }
}

// 1/4 of the colour per steradian everywhere, so 2π/4 of it in all
TEST(MeasuredSurface, OfEvenTablesShinesEvenly) {
    const Measurement even(even_numbers({0.4f, 0.2f, 0.1f}));
    for (const Vec3 o : {Vec3{0, 0, 1}, normalize({1, 2, 0.5f}), normalize({-1, 0.3f, 2})})
        for (const Vec3 i : {Vec3{0, 0, 1}, normalize({-1, 2, 0.1f}), normalize({1, 1, 1})}) {
            const Rgb value = even.value(o, i).value;
            EXPECT_NEAR(value.r, 0.1f, 1e-6f);
            EXPECT_NEAR(value.b, 0.025f, 1e-6f);
        }
}

TEST(MeasuredSurface, IsDividedByWhatTheViewerSeesOfFacets) {
    const Vec3 o = normalize({1, 2, 2}), i = normalize({-1, 2, 1});
    EXPECT_NEAR(Measurement(even_numbers({0.4f, 0, 0}, 2)).value(o, i).value.r, 0.05f, 1e-6f);
    auto plain = even_numbers({0.4f, 0, 0}, 2);
    plain.times_facets = false;
    EXPECT_NEAR(Measurement(plain).value(o, i).value.r, 0.4f, 1e-6f);
}

// θ = 40° lies at √(80/180) of the way, φ = 90° from the viewer at 3/4
TEST(MeasuredSurface, HasFacetsWhereTheirAnglesAre) {
    auto numbers = even_numbers({1, 1, 1});
    numbers.facets = {0, 1, 0, 1};  // the distance from the normal
    const float angle = 40 * pi / 180;
    const Vec3 o = normalize({1, 0, 3});
    const auto lit_by = [&](float turn) {
        const Vec3 m{std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn), std::cos(angle)};
        return Measurement(numbers).value(o, normalize(m * (2 * dot(o, m)) - o)).value.r * 4;
    };
    EXPECT_NEAR(lit_by(0.4f), std::sqrt(80.0f / 180), 1e-5f);
    numbers.facets = {0, 0, 1, 1};
    EXPECT_NEAR(lit_by(pi / 2), 0.75f, 1e-5f);
    EXPECT_NEAR(lit_by(-pi / 4), 0.375f, 1e-5f);
}

// What the file says is bound to places from which evenly distributed points go to visible facets.
TEST(MeasuredSurface, TakesColoursFromWhereVisibleFacetsComeFrom) {
    auto numbers = even_numbers({1, 1, 1});
    numbers.seen = {0, 1, 0, 1, 0, 1, 0, 1};                                        // place.x = √u.x
    for (std::size_t i = 0; i < 8; ++i) numbers.colours[i] = {float(i % 2), 0, 0};  // red: u.x
    const float angle = 30 * pi / 180;
    const Vec3 o = normalize({1, 0, 3}), m{0, std::sin(angle), std::cos(angle)};
    EXPECT_NEAR(Measurement(numbers).value(o, normalize(m * (2 * dot(o, m)) - o)).value.r * 4, 60.0f / 180, 1e-5f);
}

void expect_ggx(const Measurement& measured, float alpha_u, float alpha_v, float tolerance) {
    const Microfacets facets{alpha_u, alpha_v};
    int compared = 0;
    for (std::uint32_t k = 0; k < 400; ++k) {
        Samples samples(9, k);
        const Vec2 u = samples.next_2d(), v = samples.next_2d();
        const Vec3 o = cosine_hemisphere(u), i = cosine_hemisphere(v);
        if (o.z < 0.2f || i.z < 0.2f) continue;
        const auto [value, pdf, cosine] = reflection(facets, o, i);
        const auto found = measured.value(o, i);
        EXPECT_NEAR(found.value.g, 0.5f * value, tolerance * value + 1e-3f);
        ++compared;
    }
    EXPECT_GT(compared, 200);
}

TEST(MeasuredSurface, ShowsTheFacetsThatWereMeasured) {
    expect_ggx(Measurement(ggx_numbers(0.4f, 0.4f, {0.8f, 0.5f, 0.2f}, 64)), 0.4f, 0.4f, 0.03f);
}

TEST(MeasuredSurface, ShowsGroovesThatWereMeasured) {
    for (const std::uint32_t folds : {1, 2, 4})
        expect_ggx(Measurement(ggx_numbers(0.3f, 0.5f, {0.8f, 0.5f, 0.2f}, 48, folds)), 0.3f, 0.5f, 0.06f);
}

// pbrt turns both directions about the point
TEST(MeasuredSurface, IsSeenFromBehindAsTurnedAbout) {
    const Measurement grooves(ggx_numbers(0.3f, 0.5f, {0.8f, 0.5f, 0.2f}, 16));
    const MeasuredBsdf bsdf{&grooves};
    const Vec3 o = normalize({1, 0.4f, 2}), i = normalize({-0.8f, 0.1f, 1});
    EXPECT_EQ(bsdf.evaluate(o, i, lobe::all).value, bsdf.evaluate(-o, -i, lobe::all).value);
    EXPECT_TRUE(is_black(bsdf.evaluate(o, -i, lobe::all).value));
}

TEST(MeasuredSurface, IsNamedByWhatWasMeasured) {
    const auto name = [](Rgb colour) { return Measurement(even_numbers(colour)).content(); };
    EXPECT_EQ(name({1, 1, 1}), name({1, 1, 1}));
    EXPECT_NE(name({1, 1, 1}), name({1, 1, 0.5f}));
    auto folded = even_numbers({1, 1, 1});
    folded.folds = 2;
    EXPECT_NE(Measurement(folded).content(), name({1, 1, 1}));
}

}  // namespace
}  // namespace lightnet::measured_test
