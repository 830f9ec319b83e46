// Fibres of hair beside what is known of them.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/math/samples.hpp"
#include "core/base/math/sampling.hpp"
#include "core/scene/bsdf/bsdf.hpp"
#include "core/scene/bsdf/fresnel.hpp"
#include "tests/scene/bsdf/hair_models.hpp"

namespace lightnet::models_test {
namespace {

constexpr double tau = 2 * std::numbers::pi;

/// A direction by the sine of its tilt, and by its turn around the fibre.
Vec3 around_fibre(double sine, double turn) {
    const double cosine = std::sqrt(std::max(0.0, 1 - sine * sine));
    return {float(sine), float(cosine * std::cos(tau * turn)), float(cosine * std::sin(tau * turn))};
}

/// The integral over all directions, by even steps of both angles.
template <class Value>
double over_sphere(Value value) {
    constexpr int rows = 150, columns = 300;
    double sum = 0;
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) {
            const double tilt = ((i + 0.5) / rows - 0.5) * tau / 2;
            sum += double{value(around_fibre(std::sin(tilt), (j + 0.5) / columns))} * std::cos(tilt);
        }
    return sum * tau * tau / 2 / rows / columns;
}

struct Roughness2 {
    float along, around;
};

TEST(Hair, ThatAbsorbsNothingIsAsBrightAsAWhiteSky) {
    for (const auto& [along, around] : {Roughness2{0.1f, 0.1f}, {0.3f, 0.3f}, {0.15f, 0.9f}, {0.9f, 0.2f}, {1, 1}})
        for (const float across : {-0.95f, -0.4f, 0.0f, 0.7f})
            for (const double sine : {-0.9, -0.3, 0.0, 0.6, 0.99}) {
                const HairBsdf model = hair_of({along, around, 3}, {}, across);
                const Vec3 o = around_fibre(sine, 0.2);
                const auto whole = over_sphere([&](Vec3 i) { return model.evaluate(o, i, lobe::all).value.g; });
                EXPECT_NEAR(whole, 1, 1e-3) << along << ' ' << around << ' ' << across << ' ' << sine;
            }
}

TEST(Hair, SendsNoMoreThanItGetsHoweverDarkItIs) {
    double before = 1.001;
    for (const float absorption : {0.0f, 0.05f, 0.3f, 1.0f, 10.0f, 1e6f}) {
        const HairBsdf model = hair_of({0.3f, 0.3f, 2}, {absorption, absorption, absorption}, 0.3f);
        const Vec3 o = around_fibre(0.2, 0.1);
        const auto whole = over_sphere([&](Vec3 i) { return model.evaluate(o, i, lobe::all).value.g; });
        EXPECT_LT(whole, before);
        before = whole;
    }
    const float sine = 0.2f,
                cosine = std::sqrt(1 - sine * sine);  // of what is black inside its surface's alone is left
    EXPECT_NEAR(before, fresnel_dielectric(cosine * std::sqrt(1 - 0.09f), 1.55f), 2e-3);
}

/// The direction of light in which a smooth fibre sends most to a viewer, by samples on one of whose sides it lies.
Vec3 brightest(const HairBsdf& model, Vec3 o, Vec3 near, double& value) {
    Vec3 best = near;
    value = 0;
    for (std::uint32_t k = 0; k < 20000; ++k) {
        Samples samples(9, k);
        const Vec3 way = normalize(near + sphere(samples.next_2d()) * (0.3f * samples.next()));
        const double here = double{model.evaluate(o, way, lobe::all).value.g};
        if (here > value) value = here, best = way;
    }
    return best;
}

/// A fibre of radius 1 along x, seen at a point of it whose normal is z.
struct Cylinder {
    static Vec3 normal_at(Vec3 p) { return normalize({0, p.y, p.z}); }
    /// The way of a ray that comes in at (0, 0, 1) against `o`, after that many reflections inside.
    static Vec3 through(Vec3 o, int inside, float eta) {
        Vec3 at{0, 0, 1};
        Vec3 way = refract(o, normal_at(at), eta).direction;
        for (int i = 0;; ++i) {
            const float across2 = way.y * way.y + way.z * way.z;
            at = at + way * (-2 * (at.y * way.y + at.z * way.z) / across2);
            if (i == inside) return refract(-way, normal_at(at), eta).direction;
            way = reflect(-way, normal_at(at));
        }
    }
};

// What goes through a cylinder of glass by Snell's law, as a viewer sees it at any place of its width.
TEST(Hair, ThatIsSmoothSendsLightWhereACylinderOfGlassDoes) {
    const HairBsdf model = hair_of({0.06f, 0.06f, 0});
    for (const Vec3 o : {normalize(Vec3{0, 0, 1}), normalize(Vec3{0.3f, 0.4f, 1}), normalize(Vec3{-0.5f, -0.9f, 0.6f}),
                         normalize(Vec3{0.1f, 1.4f, 0.5f})}) {
        const auto peaks_at = [&](Vec3 expected) {
            double value = 0;
            const Vec3 found = brightest(model, o, expected, value);
            EXPECT_GT(dot(found, expected), std::cos(0.04f)) << expected.x << ' ' << expected.y << ' ' << expected.z;
            EXPECT_GT(value, 0.5);
        };
        peaks_at(reflect(o, {0, 0, 1}));
        peaks_at(Cylinder::through(o, 0, 1.55f));
    }
    const Vec3 o = normalize(Vec3{0.2f, -0.7f, 0.7f});
    double value = 0;
    const Vec3 expected = Cylinder::through(o, 1, 1.55f), found = brightest(model, o, expected, value);
    EXPECT_GT(dot(found, expected), std::cos(0.05f));
    EXPECT_GT(value, 0.1);
}

// Scales turn what is reflected by twice their angle, what goes through back by it, by pbrt's signs.
TEST(Hair, HasScalesThatTurnItsHighlights) {
    constexpr float tilt = 5;
    const HairBsdf model = hair_of({0.06f, 0.3f, tilt});
    const Vec3 o{0, 0, 1};
    const auto angle_of = [&](Vec3 near) {
        double value = 0;
        return std::asin(double{brightest(model, o, near, value).x}) * 360 / tau;
    };
    EXPECT_NEAR(angle_of({0, 0, 1}), 2 * tilt, 1.0);
    EXPECT_NEAR(angle_of({0, 0, -1}), -tilt, 1.0);
}

// Where two directions are tilted alike, a fibre as a whole sends as much from one to the other as back. At other tilts
// this model does not: what is reflected goes by the viewer's tilt alone.
TEST(Hair, IsReciprocalAsAWholeBetweenDirectionsOfOneTilt) {
    const auto whole = [](Vec3 o, Vec3 i) {
        double sum = 0;
        constexpr int places = 400;
        for (int k = 0; k < places; ++k) {
            const HairBsdf model = hair_of({0.2f, 0.3f, 0}, {0.1f, 0.4f, 1}, -1 + 2 * (float(k) + 0.5f) / places);
            sum += double{model.evaluate(o, i, lobe::all).value.r};
        }
        return sum / places;
    };
    for (const double sine : {0.0, 0.4, -0.7})
        for (const double turn : {0.05, 0.3, 0.6}) {
            const Vec3 a = around_fibre(sine, 0.1), b = around_fibre(-sine, 0.1 + turn);
            EXPECT_NEAR(whole(a, b), whole(b, a), 2e-3 * whole(a, b)) << sine << ' ' << turn;
        }
}

// The same fibre, seen as round or told where it is seen.
TEST(Hair, IsSeenWhereItsNormalSays) {
    const Vec3 o = normalize(Vec3{0.3f, -0.6f, 0.8f});
    const float across = 0.6f / std::sqrt(0.6f * 0.6f + 0.8f * 0.8f);
    for (std::uint32_t k = 0; k < 200; ++k) {
        const Vec3 i = sphere(Samples(3, k).next_2d());
        const float round = hair_of({0.3f, 0.3f, 2}).evaluate(o, i, lobe::all).value.g;
        const float told = hair_of({0.3f, 0.3f, 2}, {}, across).evaluate(o, i, lobe::all).value.g;
        EXPECT_NEAR(round, told, 1e-4f * round + 1e-6f);
    }
}

// By hand from the formulas of the papers.
TEST(HairColours, AreThoseOfTheFormulas) {
    const Rgb grey = hair_absorption({0.5f, 0.25f, 1}, 0.3f);
    EXPECT_NEAR(grey.r, 0.0138567f, 2e-6f);
    EXPECT_NEAR(grey.g, 4 * 0.0138567f, 8e-6f);
    EXPECT_NEAR(grey.b, 0, 1e-9f);
    EXPECT_NEAR(hair_absorption({0.5f, 0.5f, 0.5f}, 1).g, 0.0421797f, 1e-5f);
    EXPECT_TRUE(finite(hair_absorption({0, -1, 2}, 0.3f)));
    const Rgb brown = melanin_absorption(1.3f, 0.2f);
    EXPECT_NEAR(brown.r, 0.5821f, 1e-4f);
    EXPECT_NEAR(brown.g, 0.9861f, 1e-4f);
    EXPECT_NEAR(brown.b, 1.991f, 1e-4f);
}

TEST(Hair, IsFiniteFromAllSides) {
    for (const float eta : {1.0f, 1.55f, 3.0f})
        for (const float rough : {0.0f, 0.02f, 1.0f})
            for (const Vec3 o : {Vec3{1, 0, 0}, Vec3{-1, 0, 1e-6f}, normalize(Vec3{1, 1e-4f, 1e-4f}), Vec3{0, 1, 1e-7f},
                                 Vec3{0, 0, 1}}) {
                const HairBsdf model = hair_fibre({0, 1e30f, 0.1f}, eta, {rough, rough, 45});
                for (std::uint32_t k = 0; k < 500; ++k) {
                    Samples samples(2, k);
                    const float choice = samples.next();
                    const auto found = model.sample(o, choice, samples.next_2d(), lobe::all);
                    if (found) {
                        ASSERT_TRUE(finite(found->weight) && finite(found->incoming) && std::isfinite(found->pdf));
                    }
                    const auto [value, pdf] = model.evaluate(o, sphere(samples.next_2d()), lobe::all);
                    ASSERT_TRUE(finite(value) && std::isfinite(pdf) && pdf >= 0);
                }
            }
}

}  // namespace
}  // namespace lightnet::models_test
