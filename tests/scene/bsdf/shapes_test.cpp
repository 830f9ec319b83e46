// What single models promise.
#include <gtest/gtest.h>

#include "core/base/math/samples.hpp"
#include "core/base/math/sampling.hpp"
#include "core/scene/bsdf/bsdf.hpp"
#include "core/scene/bsdf/fresnel.hpp"

namespace lightnet::shapes_test {
namespace {

const Frame upright = Frame::around({0, 0, 1});

TEST(Fresnel, KnowsGlassAtNormalIncidenceAndAtTheCriticalAngle) {
    EXPECT_NEAR(fresnel_dielectric(1, 1.5f), 0.04f, 1e-6f);
    EXPECT_NEAR(fresnel_dielectric(-1, 1.5f), 0.04f, 1e-6f);
    EXPECT_EQ(fresnel_dielectric(-0.7f, 1.5f), 1);  // beyond 41.8° from inside
    EXPECT_LT(fresnel_dielectric(-0.76f, 1.5f), 1);
    EXPECT_EQ(fresnel_dielectric(0, 1.5f), 1);
    EXPECT_NEAR(fresnel_dielectric(0.3f, 1), 0, 1e-6f);
}

TEST(Fresnel, ConductorWithoutAbsorptionIsADielectric) {
    for (float cosine = 0.05f; cosine <= 1; cosine += 0.05f)
        EXPECT_NEAR(fresnel_conductor(cosine, 1.5f, 0), fresnel_dielectric(cosine, 1.5f), 1e-4f);
}

TEST(Fresnel, ConductorReflectsWhatItWasGiven) {
    for (const float r : {0.1f, 0.5f, 0.9999f})
        EXPECT_NEAR(fresnel_conductor(1, 1, absorption_for({r, r, r}).r), r, 1e-4f);
}

TEST(Dielectric, RefractsBySnellAndSqueezesRadiance) {
    const Bsdf glass(upright, {0, 0, 1}, DielectricBsdf{1.5f, {}});
    const auto s = glass.sample({0.6f, 0, 0.8f}, 0.999f, {}, lobe::all);
    ASSERT_TRUE(s && s->transmitted);
    EXPECT_NEAR(s->incoming.x, -0.4f, 1e-6f);
    EXPECT_NEAR(s->weight.r, 1 / 2.25f, 1e-6f);
    const auto back = glass.sample(s->incoming, 0.999f, {}, lobe::all);
    ASSERT_TRUE(back && back->transmitted);
    EXPECT_NEAR(back->incoming.x, 0.6f, 1e-6f);
    EXPECT_NEAR(s->weight.r * back->weight.r, 1, 1e-6f);
}

TEST(CoatedDiffuse, WhiteBaseUnderASmoothCoatReflectsAll) {
    const Coat coat(1.5f, {});
    const Bsdf bsdf(upright, {0, 0, 1}, CoatedDiffuseBsdf{{1, 1, 1}, &coat});
    for (const float cosine : {0.9f, 0.5f, 0.2f}) {
        double sum = 0;
        constexpr std::uint32_t tries = 1 << 16;
        for (std::uint32_t i = 0; i < tries; ++i) {
            Samples samples(2, i);
            const float choice = samples.next();
            const auto s =
                bsdf.sample({std::sqrt(1 - cosine * cosine), 0, cosine}, choice, samples.next_2d(), lobe::all);
            if (s) sum += s->weight.g;
        }
        EXPECT_NEAR(sum / tries, 1, 5e-3) << "cosine " << cosine;
    }
}

TEST(Bsdf, LetsNoLightThroughWhereTheShadingNormalIsBent) {
    const Vec3 normal{0, 0, 1};
    const Frame bent = Frame::around(normalize({0.8f, 0, 0.6f}));
    const Bsdf bsdf(bent, normal, DiffuseBsdf{{1, 1, 1}});
    const Vec3 outgoing = normalize({0.5f, 0, 0.7f});
    for (std::uint32_t i = 0; i < 1000; ++i) {
        const auto s = bsdf.sample(outgoing, 0, Samples(1, i).next_2d(), lobe::all);
        EXPECT_TRUE(!s || s->incoming.z > 0);
    }
    EXPECT_TRUE(is_black(bsdf.evaluate(outgoing, normalize({0.9f, 0, -0.1f}), lobe::all)));
}

TEST(Bsdf, IsNotBlackWhereTheShadingNormalTurnsAway) {
    const Bsdf bsdf(Frame::around(normalize({0.9f, 0, 0.3f})), {0, 0, 1}, DiffuseBsdf{{1, 1, 1}});
    const Vec3 outgoing = normalize({-0.9f, 0, 0.2f});
    EXPECT_GT(bsdf.evaluate(outgoing, {0, 0, 1}, lobe::all).r, 0.3f);
}

}  // namespace
}  // namespace lightnet::shapes_test
