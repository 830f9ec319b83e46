// Hair on the shapes of a scene: which way its fibres run, and where across them they are seen.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/base/math/samples.hpp"
#include "core/base/math/sampling.hpp"
#include "core/scene/bsdf/fresnel.hpp"
#include "core/scene/scene.hpp"
#include "core/scene/shapes/curves.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::hair_scene_test {
namespace {

using namespace test;

/// Smooth, without scales.
HairMaterial smooth_hair(SceneData& data, bool across_by_v) {
    const auto number = [&](float value) { return colour(data, {value, value, value}); };
    HairMaterial hair;
    hair.colour = hair.tilt = number(0);
    hair.along = hair.around = number(0.1f);
    hair.eta = number(1.55f);
    hair.across_by_v = across_by_v;
    return hair;
}

Curves bent() {
    Curves curves;
    for (const float i : {0.0f, 1.0f, 2.0f, 3.0f}) curves.points.push_back({0.1f * i * i, 0.05f * i * i * i, i, 0.1f});
    curves.segments = {0};
    curves.strands = {0};
    return curves;
}

/// Is light from where a mirror of that normal would send it brighter than from all around?
void expect_peak(const Bsdf& bsdf, Vec3 outgoing, Vec3 normal) {
    const Vec3 best = reflect(outgoing, normal);
    const float most = bsdf.evaluate(outgoing, best, lobe::all).g;
    for (std::uint32_t k = 0; k < 40; ++k) {
        const Vec3 aside = normalize(best + sphere(Samples(1, k).next_2d()) * 0.5f);
        if (dot(aside, best) > 0.97f) continue;
        EXPECT_LT(bsdf.evaluate(outgoing, aside, lobe::all).g, 0.8f * most);
    }
}

TEST(HairOnCurves, ReflectsByTheNormalOfTheRoundCurve) {
    for (const bool by_v : {false, true}) {
        SceneData data;
        const auto hair = material(data, smooth_hair(data, by_v));
        add(data, bent(), hair);
        data.objects.push_back({"strand", {0}});
        Instance placed;
        placed.to_world.m = {{{0, -2, 0, 5}, {2, 0, 0, 0}, {0, 0, -2, 0}, {0, 0, 0, 1}}};  // a mirror, too
        data.instances.push_back(placed);
        const Scene scene(std::move(data));
        std::size_t hits = 0;
        for (std::uint32_t i = 0; i < 4000; ++i) {
            Samples samples(4, i);
            const Vec3 from = sphere(samples.next_2d()) * 6 + Vec3{5, 0, -3};
            const Vec3 to{5 + 2 * samples.next() - 1, 2 * samples.next(), -6 * samples.next()};
            const auto hit = scene.intersect({from, normalize(to - from)});
            if (!hit) continue;
            ++hits;
            const SurfacePoint point = scene.surface(*hit);
            const Bsdf bsdf = scene.bsdf(point);
            ASSERT_EQ(bsdf.lobes(), lobe::glossy);
            ASSERT_FALSE(bsdf.opaque());
            if (dot(normalize(from - to), point.normal) < 0.4f) continue;  // from beside, other light is stronger
            expect_peak(bsdf, normalize(from - to), point.normal);
        }
        EXPECT_GT(hits, 100u);
    }
}

// Of a ribbon the place across tells which normal a round fibre had there; whichever way v runs, from both sides.
TEST(HairOnRibbons, ReflectsByTheNormalOfARoundFibre) {
    for (const bool turned : {false, true}) {
        SceneData data;
        const auto hair = material(data, smooth_hair(data, true));
        Mesh ribbon = quad({0, -0.5f, 0}, {2, 0, 0}, {0, 1, 0});  // along x, across y
        ribbon.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
        if (turned) ribbon.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
        add(data, std::move(ribbon), hair);
        const Scene scene(std::move(data));
        for (const float side : {1.0f, -1.0f})
            for (const float across : {-0.6f, 0.0f, 0.4f}) {
                const Vec3 outgoing{0, 0, side};
                const auto hit = scene.intersect({{1, across / 2, side}, -outgoing});
                ASSERT_TRUE(hit);
                const Vec3 normal{0, across, side * std::sqrt(1 - across * across)};
                expect_peak(scene.bsdf(scene.surface(*hit)), outgoing, normal);
            }
    }
}

/// Light that a point sends on of all that comes, by samples.
double albedo_at(const Scene& scene, Vec3 from, Vec3 to) {
    const auto hit = scene.intersect({from, normalize(to - from)});
    if (!hit) return -1;
    const Bsdf bsdf = scene.bsdf(scene.surface(*hit));
    double sum = 0;
    constexpr std::uint32_t count = 2000;
    for (std::uint32_t i = 0; i < count; ++i) {
        Samples samples(2, i);
        const float choice = samples.next();
        const auto found = bsdf.sample(normalize(from - to), choice, samples.next_2d(), lobe::all);
        if (found) sum += double{found->weight.g} / count;
    }
    return sum;
}

TEST(HairColours, MayChangeAlongAStrand) {
    SceneData data;
    HairMaterial hair = smooth_hair(data, false);
    hair.means = HairMaterial::Colour::reflectance;
    hair.colour = picture(data, 2, 1, {{0.01f, 0.01f, 0.01f}, {1, 1, 1}});
    add(data, bent(), material(data, hair));
    const Scene scene(std::move(data));
    const double root = albedo_at(scene, {5, 0.1f, 0.75f}, {0, 0.1f, 0.75f}),
                 tip = albedo_at(scene, {5, 0.745f, 2.25f}, {0, 0.745f, 2.25f});
    EXPECT_LT(root, 0.6);
    EXPECT_GT(root, 0.03);
    EXPECT_NEAR(tip, 1, 0.01);
}

TEST(Hair, MayBeMixedWithOthers) {
    SceneData data;
    const auto hair = material(data, smooth_hair(data, true)), grey = diffuse(data, 0.5f);
    MixtureMaterial both{grey, hair, colour(data, {0.5f, 0.5f, 0.5f})};
    add(data, bent(), material(data, both));
    const Scene scene(std::move(data));
    EXPECT_NEAR(albedo_at(scene, {5, 0, 0.15f}, {0, 0, 0.15f}), 0.75, 0.02);
}

}  // namespace
}  // namespace lightnet::hair_scene_test
