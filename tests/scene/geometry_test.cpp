#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "core/base/math/samples.hpp"
#include "core/base/math/sampling.hpp"
#include "core/scene/lamps/lights.hpp"
#include "core/scene/scene.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::geometry_test {
namespace {

using namespace test;

SceneData clutter() {
    SceneData data;
    const auto grey = diffuse(data, 0.5f);
    for (std::uint32_t i = 0; i < 60; ++i) {
        Samples samples(9, i);
        const Vec3 at = sphere(samples.next_2d());
        if (i % 3 == 0)
            add(data, ball(at, 0.1f), grey);
        else
            add(data, quad(at, sphere(samples.next_2d()) * 0.4f, sphere(samples.next_2d()) * 0.4f), grey);
    }
    return data;
}

std::vector<Ray> rays(std::size_t count) {
    std::vector<Ray> result;
    for (std::uint32_t i = 0; i < count; ++i) {
        Samples samples(4, i);
        const Vec3 origin = sphere(samples.next_2d()) * 2;
        result.push_back({origin, normalize(sphere(samples.next_2d()) - origin)});
    }
    return result;
}

bool same(const std::optional<Hit>& a, const std::optional<Hit>& b) {
    if (!a || !b) return !a == !b;
    return a->instance == b->instance && a->geometry == b->geometry && a->primitive == b->primitive && a->u == b->u &&
           a->v == b->v && a->distance == b->distance;
}

TEST(Scene, FindsTheSameHitsOneByOneAndManyAtOnce) {
    const Scene scene(clutter());
    const auto all = rays(5003);
    std::vector<std::optional<Hit>> together(all.size());
    scene.intersect(all, together);
    std::size_t hits = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const auto alone = scene.intersect(all[i]);
        ASSERT_TRUE(same(alone, together[i])) << i;
        ASSERT_EQ(scene.occluded(all[i]), alone.has_value());
        hits += alone.has_value();
    }
    EXPECT_GT(hits, 500u);
}

// What calls leave on the stack where later ones find it: huge numbers, as floats.
[[gnu::noinline]] void litter_the_stack() {
    volatile unsigned char litter[16384];
    for (auto& byte : litter) byte = 0x7f;
}

// Embree traces what lies in the lanes of a packet that nobody filled, and ends the process when that is no ray.
TEST(Scene, DoesNotTraceWhatLiesInLanesWithoutARay) {
    const Scene scene(clutter());
    const auto all = rays(16);
    for (std::size_t count = 1; count <= all.size(); ++count) {
        std::vector<std::optional<Hit>> hits(count);
        litter_the_stack();
        scene.intersect(std::span(all).first(count), hits);
        for (std::size_t i = 0; i < count; ++i) ASSERT_TRUE(same(scene.intersect(all[i]), hits[i])) << i;
    }
}

TEST(Scene, NeighboursInACallChangeNothing) {
    const Scene scene(clutter());
    const auto all = rays(1000);
    std::vector<std::optional<Hit>> together(all.size());
    scene.intersect(all, together);
    for (const std::size_t first : {1u, 5u, 13u, 500u}) {
        std::vector<std::optional<Hit>> some(all.size() - first);
        scene.intersect(std::span(all).subspan(first), some);
        for (std::size_t i = 0; i < some.size(); ++i) ASSERT_TRUE(same(some[i], together[first + i]));
    }
}

TEST(Scene, CountsTheRaysOfThisThread) {
    const Scene scene(clutter());
    const auto before = Scene::rays_of_this_thread();
    const auto all = rays(20);
    std::vector<std::optional<Hit>> hits(all.size());
    scene.intersect(all, hits);
    scene.intersect(all[0]);
    scene.occluded(all[0]);
    EXPECT_EQ(Scene::rays_of_this_thread() - before, 22u);
}

// A ray that leaves a ball outwards must never meet it again, and one that goes inwards must meet the far side.
TEST(Scene, RaysLeaveBallsCleanly) {
    for (const auto& [center, radius] : {std::pair{Vec3{390, 100.1f, 180}, 100.0f},
                                         {Vec3{0, 100, 0}, 100.0f},
                                         {Vec3{-2.5f, 5, 0}, 0.0333f},
                                         {Vec3{0, 0, 1e5f}, 1e5f},
                                         {Vec3{40, 1, 7}, 2e-2f}}) {
        SceneData data;
        add(data, ball(center, radius), diffuse(data, 0.5f));
        const Scene scene(data);
        for (std::uint32_t i = 0; i < 4000; ++i) {
            Samples samples(1, i);
            const Vec2 name = samples.next_2d();
            const SurfacePoint at = scene.surface(Hit{.u = name.x - 0.5f, .v = name.y - 0.5f});
            Vec3 way = sphere(samples.next_2d());
            if (i % 4 == 0) way = normalize(way - at.normal * (dot(way, at.normal) * 0.999f));  // grazing
            const Vec3 out = dot(way, at.normal) > 0 ? way : -way;
            ASSERT_FALSE(scene.occluded({at.origin_towards(out), out})) << "radius " << radius << " sample " << i;
            if (const float cosine = std::fabs(dot(out, at.normal)); cosine > 0.05f) {
                const auto far_side = scene.intersect({at.origin_towards(-out), -out});
                ASSERT_TRUE(far_side);
                ASSERT_NEAR(far_side->distance, 2 * cosine * radius, 1e-3f * radius + 3 * at.offset / cosine);
            }
        }
    }
}

TEST(Scene, RaysLeaveTrianglesCleanly) {
    SceneData data;
    const auto grey = diffuse(data, 0.5f);
    for (const Vec3 corner : {Vec3{0, 0, 0}, Vec3{500, -300, 800}, Vec3{-0.01f, 0.02f, 1000}})
        add(data, quad(corner, {130, 7, -20}, {-11, 9, 105}), grey);
    const Scene scene(data);
    for (std::uint32_t i = 0; i < 30000; ++i) {
        Samples samples(1, i);
        const Vec2 at = triangle(samples.next_2d());
        const SurfacePoint point = scene.surface(Hit{.geometry = i % 3, .primitive = i % 2, .u = at.x, .v = at.y});
        const Vec3 way = sphere(samples.next_2d());
        ASSERT_FALSE(scene.occluded({point.origin_towards(way), way, 50})) << i;
    }
}

TEST(Scene, NoRaySlipsOutOfAClosedRoom) {
    SceneData data;
    add(data, room(), diffuse(data, 0.5f));
    const Scene scene(data);
    for (std::uint32_t i = 0; i < 100000; ++i) {
        Samples samples(1, i);
        const Ray ray{{0.5f, 0.25f, 0.75f}, sphere(samples.next_2d())};
        ASSERT_TRUE(scene.intersect(ray));
    }
    // straight at edges and corners
    for (int i = 0; i <= 100; ++i)
        for (const Vec3 target : {Vec3{0, 0, float(i) / 100}, Vec3{1, float(i) / 100, 0}, Vec3{float(i) / 100, 1, 1}})
            ASSERT_TRUE(scene.intersect({{0.5f, 0.25f, 0.75f}, normalize(target - Vec3{0.5f, 0.25f, 0.75f})}));
}

TEST(Scene, RefusesShapesThatNameWhatIsNotThere) {
    SceneData data;
    Mesh mesh = quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    mesh.triangles.push_back({0, 1, 4});
    add(data, mesh, diffuse(data, 0.5f));
    EXPECT_THROW(Scene{data}, Error);
    SceneData lost;
    add(lost, ball({0, 0, 0}, 1), 3);
    EXPECT_THROW(Scene{lost}, Error);
}

TEST(Scene, RefusesQuestionsAboutSurfacesThatAreNotThere) {
    const Scene scene(clutter());
    EXPECT_THROW(scene.surface(Query{.geometry = 1000}), Error);
    EXPECT_THROW(scene.surface(Query{.geometry = 1, .primitive = 2}), Error);
    EXPECT_NO_THROW(scene.surface(Query{.geometry = 1, .primitive = 1}));
}

TEST(Scene, OfNothingIsEmpty) {
    const Scene scene(SceneData{});
    EXPECT_FALSE(scene.intersect({{0, 0, 0}, {0, 0, 1}}));
    EXPECT_TRUE(scene.lights().empty());
    EXPECT_FALSE(scene.lights().has_environment());
}

}  // namespace
}  // namespace lightnet::geometry_test
