// Disks, cylinders and ellipsoids.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/math/samples.hpp"
#include "core/base/math/sampling.hpp"
#include "core/scene/data/identity.hpp"
#include "core/scene/lamps/lights.hpp"
#include "core/scene/scene.hpp"
#include "core/scene/shapes/placed_quadric.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::quadrics_test {
namespace {

using namespace test;

constexpr double pi_exactly = std::numbers::pi;

Matrix columns(Vec3 x, Vec3 y, Vec3 z, Vec3 origin) {
    Matrix m;
    for (std::size_t i = 0; i < 3; ++i) m.m[i][0] = x[i], m.m[i][1] = y[i], m.m[i][2] = z[i], m.m[i][3] = origin[i];
    return m;
}

Quadric quadric(Quadric::Round round, const Matrix& to_world) {
    Quadric made;
    made.round = round;
    made.to_world = to_world;
    return made;
}

/// Of all kinds: whole and in part, stretched, sheared and mirrored, with either side out.
std::vector<std::pair<std::string, Quadric>> all_quadrics() {
    using enum Quadric::Round;
    const Matrix small = columns({0.3f, 0, 0}, {0, 0.3f, 0}, {0, 0, 0.3f}, {});
    const Matrix stretched = columns({0.5f, 0.1f, 0}, {0, 0.2f, 0.1f}, {0.1f, 0, 0.4f}, {0.1f, 0, -0.1f});
    const Matrix mirrored = columns({-0.2f, 0, 0.3f}, {0, 0.3f, 0}, {0.4f, 0.1f, 0.2f}, {0, 0.1f, 0});
    std::vector<std::pair<std::string, Quadric>> all;
    for (const auto& [name, matrix] : {std::pair("small", small), {"stretched", stretched}, {"mirrored", mirrored}})
        for (const auto round : {disk, cylinder, sphere}) {
            const std::string called = std::string(name) + std::to_string(int(round));
            all.emplace_back(called, quadric(round, matrix));
            Quadric part = all.back().second;
            part.flip_normals = true;
            all.emplace_back(called + " flipped", part);
            part.inner = 0.4f, part.low = -0.3f, part.high = 0.8f, part.turn = 4;
            all.emplace_back(called + " in part", part);
        }
    return all;
}

Scene shining(const Quadric& shape, bool two_sided = false) {
    SceneData data;
    add(data, shape, diffuse(data, 0)).emission = AreaEmission{{1, 1, 1}, two_sided};
    return Scene(std::move(data));
}

Vec3 in_ball(std::uint32_t i) {
    Samples samples(11, i);
    return sphere(samples.next_2d()) * (1.5f * samples.next());
}

TEST(Quadrics, AreMetWhereTheirPointsLie) {
    for (const auto& [name, shape] : all_quadrics()) {
        const Scene scene = shining(shape);
        std::size_t hits = 0;
        for (std::uint32_t i = 0; i < 4000; ++i) {
            Samples samples(1, i);
            const Vec3 origin = in_ball(i);
            const Ray ray{origin, normalize(sphere(samples.next_2d()) * 0.3f - origin)};
            const auto hit = scene.intersect(ray);
            ASSERT_EQ(scene.occluded(ray), hit.has_value());
            if (!hit) continue;
            ++hits;
            const SurfacePoint at = scene.surface(*hit);
            ASSERT_LT(length(at.position - (ray.origin + ray.direction * hit->distance)), 4e-6f) << name;
            ASSERT_NEAR(length(at.normal), 1, 1e-5f);
        }
        EXPECT_GT(hits, 200u) << name;
    }
}

// Some of them lie in the same place.
TEST(Quadrics, AreMetAlikeOneByOneAndManyAtOnce) {
    SceneData data;
    const auto grey = diffuse(data, 0.5f);
    for (const auto& [name, shape] : all_quadrics()) add(data, shape, grey);
    add(data, ball({0.3f, 0.2f, 0}, 0.2f), grey);
    const Scene scene(std::move(data));
    std::vector<Ray> rays;
    for (std::uint32_t i = 0; i < 2003; ++i) rays.push_back({in_ball(i), normalize(in_ball(i + 5000))});
    std::vector<std::optional<Hit>> hits(rays.size());
    scene.intersect(rays, hits);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const auto alone = scene.intersect(rays[i]);
        ASSERT_EQ(alone.has_value(), hits[i].has_value());
        if (!alone) continue;
        ASSERT_EQ(alone->geometry, hits[i]->geometry);
        ASSERT_EQ(alone->u, hits[i]->u);
        ASSERT_EQ(alone->v, hits[i]->v);
        ASSERT_EQ(alone->distance, hits[i]->distance);
    }
}

TEST(Quadrics, AreLeftCleanlyByRaysAndMetOnBothSides) {
    for (const auto& [name, shape] : all_quadrics()) {
        const Scene scene = shining(shape);
        const PlacedQuadric placed(shape);
        for (std::uint32_t i = 0; i < 2000; ++i) {
            Samples samples(3, i);
            const Vec2 at = placed.name_of(placed.own_uniform(samples.next_2d()));
            const SurfacePoint point = scene.surface(Hit{.u = at.x, .v = at.y});
            for (const float side : {1.0f, -1.0f}) {  // towards it, from a little way off
                const Vec3 from = point.position + point.normal * (side * 1e-3f);
                const auto hit = scene.intersect({from, point.normal * -side, 2e-3f});
                ASSERT_TRUE(hit) << name;
                ASSERT_LT(length(scene.surface(*hit).position - point.position), 1e-5f) << name;
            }
            Vec3 way = sphere(samples.next_2d());
            // a disk is flat; of the others, it is the convex side that must never be met again
            if (shape.round != Quadric::Round::disk && dot(way, point.normal) * (shape.flip_normals ? -1 : 1) < 0)
                way = -way;
            ASSERT_FALSE(scene.occluded({point.origin_towards(way), way})) << name << " sample " << i;
        }
    }
}

TEST(Quadrics, LightAFloorAsTheFormFactorOfADiskSays) {
    const float radius = 0.7f, height = 1.3f;
    Quadric shape =
        quadric(Quadric::Round::disk, columns({radius, 0, 0}, {0, radius, 0}, {0, 0, 1}, {0.2f, -0.3f, height}));
    shape.flip_normals = true;  // downwards
    const Scene scene = shining(shape);
    const Vec3 below{0.2f, -0.3f, 0};
    double sum = 0;
    constexpr std::uint32_t count = 20000;
    for (std::uint32_t i = 0; i < count; ++i) {
        Samples samples(2, i);
        const float choice = samples.next();
        if (const auto lamp = scene.lights().sample(LitPoint(below), choice, samples.next_2d()))
            sum += lamp->radiance.g * lamp->direction.z / lamp->pdf;
    }
    const double factor = double{radius} * radius / (double{radius} * radius + double{height} * height);
    EXPECT_NEAR(sum / count / pi_exactly / factor, 1, 2e-3);
}

// What is sampled, as far as it is seen, beside all directions that find the lamp shining.
TEST(Quadrics, FillTheSolidAngleThatRaysFind) {
    constexpr std::uint32_t count = 20000;
    for (const auto& [name, shape] : all_quadrics())
        for (const bool two_sided : {false, true}) {
            const Scene scene = shining(shape, two_sided);
            for (const Vec3 from : {Vec3{0.1f, -0.2f, 0.9f}, Vec3{-0.8f, 0.1f, -0.2f}, Vec3{0.02f, 0.05f, 0.03f}}) {
                double sampled = 0, square = 0, found = 0;
                for (std::uint32_t i = 0; i < count; ++i) {
                    Samples samples(5, i);
                    const float choice = samples.next();
                    const auto lamp = scene.lights().sample(LitPoint(from), choice, samples.next_2d());
                    const bool seen =
                        lamp && !scene.occluded({from, lamp->direction, length(lamp->position - from) * (1 - 1e-4f)});
                    const double angle = seen ? 1 / double{lamp->pdf} : 0;
                    sampled += angle, square += angle * angle;
                    const Vec3 way = sphere(samples.next_2d());
                    const auto hit = scene.intersect({from, way});
                    if (hit && !is_black(scene.lights().emission(scene.surface(*hit), -way))) found += 4 * pi_exactly;
                }
                sampled /= count, found /= count;
                const double spread = std::sqrt(std::max(0.0, square / count - sampled * sampled) / count);
                const double of_rays = std::sqrt(std::max(0.0, found * (4 * pi_exactly - found)) / count);
                EXPECT_NEAR(sampled, found, 4 * (spread + of_rays) + 1e-3) << name << (two_sided ? " both sides" : "");
            }
        }
}

TEST(Quadrics, StateTheSameDensityForAPointHoweverItIsFound) {
    for (const auto& [name, shape] : all_quadrics()) {
        const Scene scene = shining(shape);
        std::size_t compared = 0;
        for (std::uint32_t i = 0; i < 3000; ++i) {
            const LitPoint from(in_ball(i));
            Samples samples(6, i);
            const float choice = samples.next();
            const auto lamp = scene.lights().sample(from, choice, samples.next_2d());
            if (!lamp) continue;
            const auto hit = scene.intersect({from.position, lamp->direction});
            if (!hit) continue;  // its rim
            const SurfacePoint on = scene.surface(*hit);
            const float grazing = std::fabs(dot(on.normal, lamp->direction));
            if (length(on.position - lamp->position) > 1e-4f || grazing < 0.02f) continue;
            ++compared;
            ASSERT_NEAR(scene.lights().pdf(from, lamp->direction, on) / lamp->pdf, 1, 2e-2) << name;
        }
        EXPECT_GT(compared, 500u) << name;
    }
}

// A closed shape that shines inwards is a furnace: whatever the place and the direction, radiance is 1.
TEST(Quadrics, AreFurnacesFromInside) {
    Quadric shape =
        quadric(Quadric::Round::sphere, columns({2, 0.3f, 0}, {0, 1, 0.2f}, {0.1f, 0, 0.7f}, {0.1f, 0, -0.1f}));
    shape.flip_normals = true;
    const Scene scene = shining(shape);
    for (const Vec3 at : {Vec3{0.1f, 0, -0.1f}, Vec3{0.6f, 0.3f, 0}}) {
        double sum = 0;
        constexpr std::uint32_t count = 100000;
        for (std::uint32_t i = 0; i < count; ++i) {
            Samples samples(7, i);
            const float choice = samples.next();
            const auto lamp = scene.lights().sample(LitPoint(at), choice, samples.next_2d());
            if (lamp) sum += std::max(0.0f, lamp->direction.z) / lamp->pdf;
            if (i < 1000) {
                const Vec3 way = sphere(samples.next_2d());
                const auto hit = scene.intersect({at, way});
                ASSERT_TRUE(hit);
                ASSERT_EQ(scene.lights().emission(scene.surface(*hit), -way).g, 1);
            }
        }
        EXPECT_NEAR(sum / count / pi_exactly, 1, 0.02);
    }
}

TEST(Quadrics, HaveTheAreaOfTheirKind) {
    const Matrix flat = columns({2, 0, 0}, {0, 2, 0}, {0, 0, 1}, {});
    EXPECT_NEAR(PlacedQuadric(quadric(Quadric::Round::disk, flat)).area(), 4 * pi_exactly, 1e-4);
    EXPECT_NEAR(PlacedQuadric(quadric(Quadric::Round::cylinder, flat)).area(), 4 * pi_exactly, 1e-4);
    const double e = std::sqrt(1 - 0.25);  // of an oblate spheroid, half as high as wide
    const double oblate = 2 * pi_exactly * 4 * (1 + (1 - e * e) / e * std::atanh(e));
    EXPECT_NEAR(PlacedQuadric(quadric(Quadric::Round::sphere, flat)).area() / oblate, 1, 1e-3);
}

TEST(Quadrics, HaveTextureCoordinatesThatGrowAsTheirTangentsSay) {
    for (auto [name, shape] : all_quadrics()) {
        shape.to_uv = {{{0, -1, 1}, {-1, 0, 1}}};
        const PlacedQuadric placed(shape);
        for (std::uint32_t i = 0; i < 200; ++i) {
            Samples samples(8, i);
            const Vec2 u = samples.next_2d();
            const Vec3 own = placed.own_uniform({0.1f + 0.8f * u.x, 0.1f + 0.8f * u.y});
            if (own.x * own.x + own.y * own.y < 0.01f || (own.x > 0 && std::fabs(own.y) < 0.01f)) continue;
            const auto [along_u, along_v] = placed.along(own);
            constexpr float step = 1e-3f;
            const Vec3 aside = placed.position(own) + along_u * step;
            const Vec2 moved = placed.uv(placed.own_point(placed.name_near(aside))), at = placed.uv(own);
            ASSERT_NEAR((moved.x - at.x) / step, 1, 0.05) << name;
            ASSERT_NEAR((moved.y - at.y) / step, 0, 0.05) << name;
            const Vec2 up = placed.uv(placed.own_point(placed.name_near(placed.position(own) + along_v * step)));
            ASSERT_NEAR((up.y - at.y) / step, 1, 0.05) << name;
        }
    }
}

TEST(Quadrics, AreFoundNearAPlaceInAnInstanceToo) {
    SceneData data;
    add(data, quadric(Quadric::Round::cylinder, columns({0.3f, 0, 0}, {0, 0.3f, 0}, {0, 0, 0.3f}, {})),
        diffuse(data, 0.5f));
    data.objects.push_back({"tin", {0}});
    data.instances.push_back({0, columns({2, 0, 0}, {0, 0.5f, 0.1f}, {0, 0, 1}, {0.5f, 0, 0})});
    const Scene scene(std::move(data));
    for (std::uint32_t i = 0; i < 500; ++i) {
        Samples samples(9, i);
        const float turn = samples.next(), height = 0.3f * samples.next();
        const SurfacePoint at = scene.surface(Hit{.instance = 0, .u = 4 * turn - 2, .v = height});
        const auto found = scene.nearest(at.position, at.normal, 0.01f);
        ASSERT_TRUE(found);
        ASSERT_LT(length(scene.surface(*found).position - at.position), 1e-5f);
    }
}

TEST(Quadrics, BelongToAScenesIdentityWithAllThatTheyAre) {
    const auto identity_with = [](auto change) {
        SceneData data;
        Quadric shape;
        change(shape);
        add(data, shape, diffuse(data, 0.5f));
        return identity_of(data);
    };
    const auto plain = identity_with([](Quadric&) {});
    EXPECT_EQ(plain, identity_with([](Quadric&) {}));
    EXPECT_NE(plain, identity_with([](Quadric& q) { q.round = Quadric::Round::cylinder; }));
    EXPECT_NE(plain, identity_with([](Quadric& q) { q.inner = 0.5f; }));
    EXPECT_NE(plain, identity_with([](Quadric& q) { q.low = 0; }));
    EXPECT_NE(plain, identity_with([](Quadric& q) { q.high = 0.5f; }));
    EXPECT_NE(plain, identity_with([](Quadric& q) { q.turn = 1; }));
    EXPECT_NE(plain, identity_with([](Quadric& q) { q.flip_normals = true; }));
    EXPECT_NE(plain, identity_with([](Quadric& q) { q.to_world.m[0][0] = 2; }));
    EXPECT_NE(plain, identity_with([](Quadric& q) { q.to_uv[0][0] = 2; }));
}

TEST(Quadrics, ThatAreSquashedToNothingAreAMistakeOfTheScene) {
    SceneData data;
    add(data, quadric(Quadric::Round::sphere, columns({1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {})), diffuse(data, 0.5f));
    EXPECT_THROW(Scene(std::move(data)), Error);
}

}  // namespace
}  // namespace lightnet::quadrics_test
