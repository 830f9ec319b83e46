// From positions back to surface points.
#include "core/scene/surface_lookup.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/base/math/samples.hpp"
#include "core/base/math/sampling.hpp"
#include "core/scene/scene.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::surface_lookup_test {
namespace {

using namespace test;

Matrix turned(Vec3 x, Vec3 y, Vec3 z, Vec3 origin) {
    Matrix m;
    for (std::size_t i = 0; i < 3; ++i) m.m[i][0] = x[i], m.m[i][1] = y[i], m.m[i][2] = z[i], m.m[i][3] = origin[i];
    return m;
}

/// A room of a metre, and an object of a quad and a ball that stands in it turned, mirrored and stretched.
SceneData furnished() {
    SceneData data;
    const auto grey = diffuse(data, 0.5f);
    add(data, room(), grey);
    add(data, quad({-0.1f, 0, -0.1f}, {0.2f, 0.05f, 0}, {0, 0.02f, 0.2f}), grey);
    add(data, ball({0, 0.15f, 0}, 0.08f), grey);
    add(data, ball({0.5f, 0.9f, 0.5f}, 0.05f), grey);
    data.objects.push_back({"thing", {2, 1}});
    const Frame f = Frame::around(normalize({0.3f, 1, 0.2f}));
    data.instances.push_back({0, turned(f.x, f.y, f.z, {0.3f, 0.3f, 0.3f})});
    data.instances.push_back({0, turned(f.x * -1, f.y * 0.7f, f.z * 0.7f, {0.7f, 0.3f, 0.7f})});
    data.instances.push_back({0, turned(f.x * 2, f.y * 0.4f, f.z * 1.2f + f.x * 0.3f, {0.3f, 0.6f, 0.7f})});
    return data;
}

std::vector<Hit> hits_in(const Scene& scene, std::size_t count) {
    std::vector<Hit> hits;
    for (std::uint32_t i = 0; hits.size() < count; ++i) {
        Samples samples(5, i);
        const Vec3 from = Vec3{0.5f, 0.5f, 0.5f} + sphere(samples.next_2d()) * 0.3f;
        if (const auto hit = scene.intersect({from, sphere(samples.next_2d())})) hits.push_back(*hit);
    }
    return hits;
}

bool names_the_same(const Hit& a, const Hit& b) {
    return a.instance == b.instance && a.geometry == b.geometry && a.primitive == b.primitive && a.u == b.u &&
           a.v == b.v;
}

TEST(SurfaceLookup, FindsWhatItWasGivenToTheBit) {
    const Scene scene(furnished());
    SurfaceLookup lookup(scene);
    const auto hits = hits_in(scene, 500);
    std::vector<Vec3> positions;
    for (const Hit& hit : hits) positions.push_back(lookup.point(hit).position);
    for (std::size_t i = 0; i < hits.size(); ++i) {
        const auto question = lookup.question(positions[i], {}, {0, 1, 0});
        ASSERT_TRUE(question);
        EXPECT_TRUE(names_the_same(scene.hit(*question), hits[i])) << i;
        EXPECT_EQ(question->outgoing, (Vec3{0, 1, 0}));
    }
    const Query asked{.geometry = 3, .u = 0.25f, .v = -0.5f};
    const auto again = lookup.question(lookup.point(asked).position, {}, {});
    ASSERT_TRUE(again);
    EXPECT_EQ(*again, asked);
}

TEST(SurfaceLookup, KnowsTheLastOfManyPositions) {
    const Scene scene(furnished());
    SurfaceLookup lookup(scene);
    const auto hits = hits_in(scene, SurfaceLookup::most_known + 300);
    for (const Hit& hit : hits) lookup.point(hit);
    for (std::size_t i = 300; i < hits.size(); ++i)
        EXPECT_TRUE(names_the_same(*lookup.find(scene.surface(hits[i]).position), hits[i])) << i;
}

TEST(SurfaceLookup, FindsTheNearestSurfaceWhereAPositionIsNotItsOwn) {
    const Scene scene(furnished());
    const SurfaceLookup lookup(scene);
    const float reach = SurfaceLookup::reach * scene.radius();
    std::size_t in_instances = 0, on_balls = 0;
    for (const Hit& hit : hits_in(scene, 2000)) {
        const SurfacePoint at = scene.surface(hit);
        for (const float height : {-0.5f, 0.2f, 0.9f}) {
            const Vec3 beside = at.position + at.normal * (height * reach);
            const auto found = lookup.find(beside);
            ASSERT_TRUE(found);
            const float distance = length(scene.surface(*found).position - beside);
            EXPECT_LE(distance, std::fabs(height) * reach * 1.01f + 1e-6f);
            in_instances += found->instance != Query::no_instance;
            on_balls += found->geometry > 1;
        }
    }
    EXPECT_GT(in_instances, 100u);
    EXPECT_GT(on_balls, 50u);
}

TEST(SurfaceLookup, FindsNothingBeyondItsReach) {
    const Scene scene(furnished());
    const SurfaceLookup lookup(scene);
    const float reach = SurfaceLookup::reach * scene.radius();
    EXPECT_FALSE(lookup.find({0.5f, 0.5f, 0.5f}));
    EXPECT_FALSE(lookup.find({0.9f, 1.1f * reach, 0.1f}));
    EXPECT_TRUE(lookup.find({0.9f, 0.9f * reach, 0.1f}));
    EXPECT_TRUE(lookup.find({0.9f, -0.9f * reach, 0.1f})) << "on either side";
    EXPECT_FALSE(lookup.question({NAN, 0, 0}, {}, {}));
    EXPECT_EQ(lookup.origin({0.5f, 0.5f, 0.5f}, {0, 1, 0}), (Vec3{0.5f, 0.5f, 0.5f})) << "of an eye";
}

TEST(SurfaceLookup, TakesTheSurfaceThatLiesAsTheNormalSays) {
    const Scene scene(furnished());
    const SurfaceLookup lookup(scene);
    const float step = 0.2f * SurfaceLookup::reach * scene.radius();
    const Vec3 in_the_corner{step, 2 * step, 1.5f * step};
    for (const Vec3 normal : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}, Vec3{0, 0, -1}}) {
        const auto found = lookup.find(in_the_corner, normal);
        ASSERT_TRUE(found);
        EXPECT_NEAR(std::fabs(dot(scene.surface(*found).normal, normal)), 1, 1e-5);
    }
    EXPECT_NEAR(std::fabs(scene.surface(*lookup.find(in_the_corner)).normal.x), 1, 1e-5) << "else the nearest";
}

TEST(SurfaceLookup, ForgetsWhatItWasGivenBefore) {
    SceneData data;
    const auto grey = diffuse(data, 0.5f);
    for (int twice = 0; twice < 2; ++twice) add(data, quad({0, 0, 0}, {0, 0, 1}, {1, 0, 0}), grey);
    const Scene scene(std::move(data));
    SurfaceLookup lookup(scene);
    const Vec3 position = lookup.point(Hit{.geometry = 1, .u = 0.25f, .v = 0.25f}).position;
    EXPECT_EQ(lookup.find(position)->geometry, 1u);
    lookup.forget();
    EXPECT_EQ(lookup.find(position)->geometry, 0u) << "of two that lie alike, the first";
}

TEST(SurfaceLookup, LooksThroughHoles) {
    SceneData data;
    const auto grey = diffuse(data, 0.5f);
    const TextureId whole = colour(data, {1, 1, 1}), none = colour(data, {0, 0, 0});
    data.textures.push_back({{1, 1, 1}, CheckerTexture{whole, none, {}}});
    const auto board = TextureId(data.textures.size() - 1);
    const auto pattern = diffuse(data, 0.5f);
    data.materials[pattern].opacity = board;
    Mesh sheet = quad({0, 0, 0}, {0, 0, 2}, {2, 0, 0});
    sheet.uvs = {{0, 0}, {2, 0}, {2, 2}, {0, 2}};
    add(data, sheet, pattern);
    add(data, quad({0, -1, 0}, {0, 0, 2}, {2, 0, 0}), grey);
    const Scene scene(std::move(data));
    const SurfaceLookup lookup(scene);
    std::size_t found = 0;
    for (const Vec3 at : {Vec3{0.5f, 0, 0.5f}, Vec3{0.5f, 0, 1.5f}, Vec3{1.5f, 0, 0.5f}, Vec3{1.5f, 0, 1.5f}}) {
        const bool met = scene.intersect({at + Vec3{0, 0.5f, 0}, {0, -1, 0}, 0.75f}).has_value();
        EXPECT_EQ(lookup.find(at).has_value(), met);
        found += met;
    }
    EXPECT_EQ(found, 2u);
}

TEST(SurfaceLookup, FindsTheSameWithEveryInstructionSet) {
    const Scene one(furnished(), {.isa = "avx2"}), other(furnished(), {.isa = "sse4.2"});
    const SurfaceLookup first(one), second(other);
    const float reach = SurfaceLookup::reach * one.radius();
    for (const Hit& hit : hits_in(one, 1000)) {
        const SurfacePoint at = one.surface(hit);
        const Vec3 beside = at.position + Vec3{0.3f, -0.4f, 0.5f} * reach;
        const auto a = first.find(beside, at.normal), b = second.find(beside, at.normal);
        ASSERT_EQ(a.has_value(), b.has_value());
        EXPECT_TRUE(!a || names_the_same(*a, *b));
    }
}

}  // namespace
}  // namespace lightnet::surface_lookup_test
