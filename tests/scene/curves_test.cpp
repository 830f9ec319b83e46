// Hair: round curves.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/math/samples.hpp"
#include "core/base/math/sampling.hpp"
#include "core/scene/data/identity.hpp"
#include "core/scene/lamps/lights.hpp"
#include "core/scene/scene.hpp"
#include "core/scene/shapes/curves.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::curves_test {
namespace {

using namespace test;

constexpr double pi_exactly = std::numbers::pi;

/// A segment along z from 0 to 1.
Curves straight(float first_radius, float last_radius, Vec3 at = {}) {
    Curves curves;
    for (int i = 0; i < 4; ++i) {
        const float along = float(i) / 3;
        curves.points.push_back({at.x, at.y, at.z + along, first_radius + (last_radius - first_radius) * along});
    }
    curves.segments = {0};
    curves.strands = {0};
    return curves;
}

/// Three segments that wind through the unit ball.
Curves winding(Curves::Basis basis) {
    Curves curves;
    curves.basis = basis;
    const std::size_t step = basis == Curves::Basis::bezier ? 3 : 1;
    for (std::uint32_t i = 0; i < 3 * step + (basis == Curves::Basis::bezier ? 1 : 3); ++i) {
        const float along = float(i) / float(3 * step);
        curves.points.push_back(
            {0.5f * std::cos(4 * along), 0.5f * std::sin(4 * along), along - 0.5f, 0.05f + 0.05f * along});
    }
    for (std::uint32_t s = 0; s < 3; ++s) curves.segments.push_back(std::uint32_t(s * step));
    curves.strands = {0};
    return curves;
}

Scene scene_of(Curves curves) {
    SceneData data;
    add(data, std::move(curves), diffuse(data, 0.5f)).emission = AreaEmission{{1, 1, 1}};
    return Scene(std::move(data));
}

Ray ray_through(std::uint32_t i) {
    Samples samples(7, i);
    const Vec3 origin = sphere(samples.next_2d()) * 2;
    return {origin, normalize(sphere(samples.next_2d()) * (0.6f * samples.next()) - origin)};
}

TEST(Curves, OfConstantWidthAreCylinders) {
    SceneData data;
    Quadric tin;
    tin.round = Quadric::Round::cylinder;
    tin.to_world.m = {{{0.1, 0, 0, 0}, {0, 0.1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
    add(data, tin, diffuse(data, 0.5f));
    const Scene cylinder(std::move(data)), curve = scene_of(straight(0.1f, 0.1f));
    std::size_t met = 0, differ = 0;
    for (std::uint32_t i = 0; i < 20000; ++i) {
        Samples samples(3, i);
        const Vec2 at = samples.next_2d(), turned = samples.next_2d();
        const Vec3 away = normalize(Vec3{std::cos(6.3f * turned.x), std::sin(6.3f * turned.x), turned.y - 0.5f});
        const Vec3 target = Vec3{0, 0, at.x} + normalize(cross(away, {0, 0, 1})) * (0.3f * (at.y - 0.5f));
        const Ray ray{target + away * 2, -away};
        const auto a = cylinder.intersect(ray), b = curve.intersect(ray);
        const bool outside = a && dot(cylinder.surface(*a).normal, away) > 0;  // a cylinder is seen from inside, too
        if (outside != b.has_value()) ++differ;
        if (!outside || !b) continue;
        ++met;
        const SurfacePoint on = cylinder.surface(*a), hair = curve.surface(*b);
        ASSERT_NEAR(a->distance, b->distance, 2e-4f);
        if (dot(on.normal, away) < 0.05f) continue;  // its rim, where a little way is a large angle
        ASSERT_GT(dot(on.normal, hair.normal), 0.9999f);
        ASSERT_LT(length(on.position - hair.position), 3e-4f);
    }
    EXPECT_GT(met, 5000u);
    EXPECT_LT(differ, 40u);
}

TEST(Curves, OfGrowingWidthAreCones) {
    const Scene scene = scene_of(straight(0.3f, 0.1f));
    const float slope = 0.2f, size = std::sqrt(1 + slope * slope);
    for (std::uint32_t i = 0; i < 100; ++i) {
        Samples samples(4, i);
        const float turn = 6.3f * samples.next(), height = 0.1f + 0.8f * samples.next();
        const Vec3 out{std::cos(turn), std::sin(turn), 0};
        const auto hit = scene.intersect({out * 2 + Vec3{0, 0, height}, -out});
        ASSERT_TRUE(hit);
        EXPECT_NEAR(hit->distance, 2 - (0.3f - slope * height), 1e-4f);
        const Vec3 normal = Vec3{out.x, out.y, slope} / size;
        EXPECT_GT(dot(scene.surface(*hit).normal, normal), 0.9999f);
    }
}

TEST(Curves, AreMetWhereTheirPointsLie) {
    for (const auto basis : {Curves::Basis::bezier, Curves::Basis::b_spline}) {
        const Scene scene = scene_of(winding(basis));
        std::size_t hits = 0;
        for (std::uint32_t i = 0; i < 20000; ++i) {
            const Ray ray = ray_through(i);
            const auto hit = scene.intersect(ray);
            ASSERT_EQ(scene.occluded(ray), hit.has_value());
            if (!hit) continue;
            ++hits;
            const SurfacePoint at = scene.surface(*hit);
            ASSERT_LT(length(at.position - (ray.origin + ray.direction * hit->distance)), 1e-3f);
            ASSERT_LT(dot(at.normal, ray.direction), 1e-2f);
        }
        EXPECT_GT(hits, 1000u);
    }
}

TEST(Curves, AreMetAlikeOneByOneAndManyAtOnce) {
    SceneData data;
    const auto grey = diffuse(data, 0.5f);
    for (const auto basis : {Curves::Basis::bezier, Curves::Basis::b_spline}) add(data, winding(basis), grey);
    data.objects.push_back({"one", {1}});
    Instance placed;
    placed.to_world.m = {{{0.5, 0, 0.2, 0.1}, {0, 0.7, 0, 0}, {0, 0.1, 0.4, 0}, {0, 0, 0, 1}}};
    data.instances.push_back(placed);
    const Scene scene(std::move(data));
    std::vector<Ray> rays;
    for (std::uint32_t i = 0; i < 20003; ++i) rays.push_back(ray_through(i));
    std::vector<std::optional<Hit>> hits(rays.size());
    scene.intersect(rays, hits);
    std::size_t in_instance = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const auto alone = scene.intersect(rays[i]);
        ASSERT_EQ(alone.has_value(), hits[i].has_value());
        if (!alone) continue;
        in_instance += alone->instance == 0;
        ASSERT_EQ(alone->instance, hits[i]->instance);
        ASSERT_EQ(alone->geometry, hits[i]->geometry);
        ASSERT_EQ(alone->primitive, hits[i]->primitive);
        ASSERT_EQ(alone->u, hits[i]->u);
        ASSERT_EQ(alone->v, hits[i]->v);
        ASSERT_EQ(alone->distance, hits[i]->distance);
        const Vec3 met = rays[i].origin + rays[i].direction * alone->distance;
        ASSERT_LT(length(scene.surface(*alone).position - met), 1e-3f);
    }
    EXPECT_GT(in_instance, 200u);
}

TEST(Curves, AreLeftByRaysOnBothSides) {
    const Scene scene = scene_of(straight(0.1f, 0.05f));
    for (std::uint32_t i = 0; i < 4000; ++i) {
        Samples samples(5, i);
        const Vec2 name = samples.next_2d();
        const SurfacePoint point = scene.surface(Hit{.u = name.x, .v = 4 * name.y - 2});
        const Vec3 way = sphere(samples.next_2d());
        ASSERT_FALSE(scene.occluded({point.origin_towards(way), way})) << i;
    }
}

TEST(Curves, AreFoundAgainByTheirNearestPoint) {
    const Scene scene = scene_of(winding(Curves::Basis::b_spline));
    for (std::uint32_t i = 0; i < 300; ++i) {
        Samples samples(6, i);
        const Vec2 name = samples.next_2d();
        const SurfacePoint point = scene.surface(Hit{.primitive = i % 3, .u = name.x, .v = 4 * name.y - 2});
        const auto found = scene.nearest(point.position + point.normal * 1e-3f, {}, 0.01f);
        ASSERT_TRUE(found) << i;
        ASSERT_LT(length(scene.surface(*found).position - point.position), 2e-3f) << i;
    }
}

TEST(Curves, HaveTheAreaOfTheirCones) {
    const double slant = std::sqrt(1.0 + 0.2 * 0.2);
    EXPECT_NEAR(straight(0.3f, 0.1f).area(), pi_exactly * 0.4 * slant, 1e-5);
}

TEST(Curves, LayTexturesAlongTheirStrands) {
    Curves curves = winding(Curves::Basis::bezier);
    curves.append(straight(0.1f, 0.1f, {3, 0, 0}));
    EXPECT_EQ(curves.strands, (std::vector<std::uint32_t>{0, 3}));
    EXPECT_FLOAT_EQ(curves.share(1).start, 1.0f / 3);
    EXPECT_FLOAT_EQ(curves.share(2).size, 1.0f / 3);
    EXPECT_FLOAT_EQ(curves.share(3).start, 0);
    EXPECT_FLOAT_EQ(curves.share(3).size, 1);
    EXPECT_FLOAT_EQ(curves.at(3, 0.5f).position.x, 3);
}

// What is sampled, as far as it is seen, beside all directions that find the lamp shining.
TEST(Curves, ShineIntoTheSolidAngleThatRaysFind) {
    constexpr std::uint32_t count = 40000;
    const Scene scene = scene_of(winding(Curves::Basis::bezier));
    for (const Vec3 from : {Vec3{0.1f, -0.2f, 1.2f}, Vec3{-1.4f, 0.1f, -0.2f}}) {
        double sampled = 0, square = 0, found = 0;
        for (std::uint32_t i = 0; i < count; ++i) {
            Samples samples(5, i);
            const float choice = samples.next();
            const auto lamp = scene.lights().sample(LitPoint(from), choice, samples.next_2d());
            const bool seen =
                lamp && !scene.occluded({from, lamp->direction, length(lamp->position - from) * (1 - 1e-3f)});
            const double angle = seen ? 1 / double{lamp->pdf} : 0;
            sampled += angle, square += angle * angle;
            const Vec3 way = sphere(samples.next_2d());
            const auto hit = scene.intersect({from, way});
            if (hit && !is_black(scene.lights().emission(scene.surface(*hit), -way))) found += 4 * pi_exactly;
        }
        sampled /= count, found /= count;
        const double spread = std::sqrt(std::max(0.0, square / count - sampled * sampled) / count);
        const double of_rays = std::sqrt(std::max(0.0, found * (4 * pi_exactly - found)) / count);
        EXPECT_NEAR(sampled, found, 4 * (spread + of_rays) + 1e-3);
    }
}

TEST(Curves, SayWhatIsWrongWithThem) {
    EXPECT_EQ(straight(0.1f, 0.1f).fault(), "");
    Curves short_one = straight(0.1f, 0.1f);
    short_one.segments = {1};
    EXPECT_EQ(short_one.fault(), "a segment names a point that isn't there");
    EXPECT_EQ(straight(-0.1f, 0.1f).fault(), "the radius of a point must be 0 or more");
    Curves unordered = straight(0.1f, 0.1f);
    unordered.strands = {1};
    EXPECT_EQ(unordered.fault(), "its strands don't follow each other");
}

TEST(Curves, AreTakenIntoTheSceneItself) {
    const auto identity = [](float radius) {
        SceneData data;
        add(data, straight(radius, radius), diffuse(data, 0.5f));
        return identity_of(data);
    };
    EXPECT_EQ(identity(0.1f), identity(0.1f));
    EXPECT_NE(identity(0.1f), identity(0.2f));
}

// Control points, what finds them, and the tree.
TEST(Curves, TakeAtMost150BytesASegment) {
    constexpr std::uint32_t strands = 2500, each = 4;
    Curves curves;
    for (std::uint32_t s = 0; s < strands; ++s) {
        Samples samples(8, s);
        const Vec3 root = sphere(samples.next_2d()), aside = sphere(samples.next_2d()) * 0.02f;
        curves.strands.push_back(std::uint32_t(curves.segments.size()));
        for (std::uint32_t i = 0; i <= 3 * each; ++i) {
            const Vec3 at = root * (1 + 0.02f * float(i)) + aside * (float(i * i) / 9);
            if (i % 3 == 0 && i < 3 * each) curves.segments.push_back(std::uint32_t(curves.points.size()));
            curves.points.push_back({at.x, at.y, at.z, 1e-3f});
        }
    }
    SceneData data;
    add(data, std::move(curves), diffuse(data, 0.5f));
    const SceneSize size = Scene(std::move(data)).size();
    EXPECT_LE(double(size.shape_bytes + size.tree_bytes) / (strands * each), 150);
}

}  // namespace
}  // namespace lightnet::curves_test
