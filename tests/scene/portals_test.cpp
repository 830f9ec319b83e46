// Windows through which light from infinity comes, and nowhere else.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/base/math/samples.hpp"
#include "core/base/math/sampling.hpp"
#include "core/scene/bare_lights/environment.hpp"
#include "core/scene/lamps/lights.hpp"
#include "core/scene/scene.hpp"
#include "tests/support/both_ways.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::portals_test {
namespace {

using namespace test;

// Two metres above the floor, seen upwards.
Portal skylight(float x) { return {{x, 2, -0.5f}, {0, 0, 1}, {1, 0, 0}}; }

EnvironmentData even_sky(Rgb radiance, const Portal& portal) {
    EnvironmentData data;
    data.radiance = radiance;
    data.portal = portal;
    return data;
}

EnvironmentData map_of_sky(const Portal& portal) {
    std::vector<Rgb> pixels;
    for (std::uint32_t i = 0; i < 32 * 16; ++i) {
        Samples samples(7, i);
        pixels.push_back({samples.next(), samples.next(), 4 * samples.next()});
    }
    EnvironmentData data;
    data.image = std::make_shared<const Image>(32, 16, pixels);
    data.portal = portal;
    return data;
}

TEST(Portal, IsPassedOutwardsBetweenItsEdges) {
    const Portal portal{{0, 0, 5}, {2, 0, 0}, {0, 1, 0}};
    EXPECT_TRUE(portal.passes({1, 0.5f, 0}, {0, 0, 1}));
    EXPECT_TRUE(portal.passes({1, 4.5f, 1}, normalize({0, -1, 1})));
    EXPECT_FALSE(portal.passes({1, 0.5f, 0}, {0, 0, -1}));
    EXPECT_FALSE(portal.passes({1, 0.5f, 6}, {0, 0, 1})) << "it lies behind";
    EXPECT_FALSE(portal.passes({1, 0.5f, 6}, {0, 0, -1})) << "inwards";
    EXPECT_FALSE(portal.passes({2.1f, 0.5f, 0}, {0, 0, 1}));
    EXPECT_FALSE(portal.passes({1, -0.1f, 0}, {0, 0, 1}));
    EXPECT_FALSE(portal.passes({1, 0.5f, 0}, {1, 0, 0}));
}

TEST(Portal, ShowsItsOwnSkyOnly) {
    SceneData data;
    add(data, quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}), diffuse(data, 1));
    data.environments = {even_sky({1, 0, 0}, skylight(-2)), even_sky({0, 1, 0}, skylight(1))};
    const Scene scene(data);
    const auto seen = [&](Vec3 from, Vec3 to) { return scene.lights().environment(Ray{from, normalize(to - from)}); };
    EXPECT_EQ(seen({0, 1, 0}, {-1.5f, 2, 0}), (Rgb{1, 0, 0}));
    EXPECT_EQ(seen({0, 1, 0}, {1.5f, 2, 0}), (Rgb{0, 1, 0}));
    EXPECT_EQ(seen({0, 1, 0}, {0, 2, 0}), (Rgb{0, 0, 0}));
    EXPECT_EQ(seen({0, 3, 0}, {0, 4, 0}), (Rgb{0, 0, 0}));
}

// The mean over the half sphere above, by its cosine, of what the scene shows from where `origin(direction)` is.
double mean_shown(const Scene& scene, int side, const auto& origin) {
    double mean = 0;
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j) {
            const Vec3 d = cosine_hemisphere({(float(i) + 0.5f) / float(side), (float(j) + 0.5f) / float(side)});
            const Vec3 up{d.x, d.z, d.y};
            mean += scene.lights().environment(Ray{origin(up), up}).b / (double(side) * side);
        }
    return mean;
}

// The irradiance of a floor, by both ways to find light, against what the portals show.
TEST(Portal, LightsAFloorAsMuchAsItShows) {
    for (const bool even : {false, true}) {
        SceneData data;
        add(data, quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}), diffuse(data, 1));
        data.environments = {map_of_sky(skylight(-1)), map_of_sky(skylight(0.5f))};
        if (even) data.environments.push_back(even_sky({0.5f, 0.5f, 0.5f}, skylight(-0.2f)));
        const Scene scene(data);
        const double expected = mean_shown(scene, 1000, [](Vec3) { return Vec3{0, 0, 0}; });
        ASSERT_GT(expected, 0.1);
        const SurfacePoint point = scene.surface(Query{.primitive = 0, .u = 0, .v = 0.5f});
        const Bsdf bsdf = scene.bsdf(point);
        double sum = 0, squares = 0;
        constexpr std::uint32_t samples = 1 << 16;
        for (std::uint32_t i = 0; i < samples; ++i) {
            const double value = both_ways(scene, point, bsdf, Samples(4, i)).b;
            sum += value, squares += value * value;
        }
        const double mean = sum / samples, error = std::sqrt((squares / samples - mean * mean) / samples);
        EXPECT_NEAR(mean, expected, 4 * error + 2e-3 * expected);
        EXPECT_LT(error, 0.02 * mean);
    }
}

// Nobody chooses among lights where there is one.
TEST(Portal, LightsAFloorWhereItsSkyIsAllThereIs) {
    SceneData data;
    add(data, quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}), diffuse(data, 1));
    data.environments = {map_of_sky(skylight(-1))};
    const Scene scene(data);
    ASSERT_FALSE(scene.lights().many());
    constexpr int n = 300;
    const double expected = mean_shown(scene, n, [](Vec3) { return Vec3{0, 0, 0}; });
    double sum = 0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const Vec2 u{(float(i) + 0.5f) / n, (float(j) + 0.5f) / n};
            if (const auto found = scene.lights().sample(LitPoint({0, 0, 0}), 0, u))
                sum += found->radiance.b * std::max(0.0f, found->direction.y) / found->pdf / (double{n} * n);
        }
    EXPECT_NEAR(sum / std::numbers::pi / expected, 1, 0.01);
}

TEST(Portal, IsAskedByManyAsByOne) {
    for (const std::size_t maps : {1, 2}) {
        SceneData data;
        add(data, quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}), diffuse(data, 1));
        data.environments = {even_sky({1, 2, 3}, skylight(0)), map_of_sky(skylight(-1))};
        if (maps == 2) data.environments.push_back(map_of_sky(skylight(1)));
        const Scene scene(data);
        std::vector<LitPoint> from;
        std::vector<float> choices;
        std::vector<Vec2> u;
        std::vector<Ray> rays;
        for (std::uint32_t i = 0; i < lanes; ++i) {
            Samples samples(3, i);
            choices.push_back(samples.next());
            u.push_back(samples.next_2d());
            from.emplace_back(sphere(samples.next_2d()));
            rays.push_back({from.back().position, normalize(Vec3{0, 2, 0} - from.back().position)});
        }
        LightSamples found;
        scene.lights().sample(from, choices, u, found);
        std::array<SkyRadiance, lanes> seen;
        scene.lights().look_at_sky(rays, seen);
        for (std::size_t i = 0; i < lanes; ++i) {
            const auto one = scene.lights().sample(from[i], choices[i], u[i]);
            ASSERT_EQ(found.found[i] != 0, one.has_value());
            if (one) {
                EXPECT_EQ(found[i], *one);
                EXPECT_EQ(one->pdf, scene.lights().environment_pdf(Ray{from[i].position, one->direction}));
            }
            EXPECT_EQ(seen[i].radiance, scene.lights().environment(rays[i]));
            EXPECT_EQ(seen[i].pdf, scene.lights().environment_pdf(rays[i]));
        }
    }
}

TEST(Portal, LetsPiTimesItsAreaTimesRadianceIn) {
    SceneData data;
    add(data, quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}), diffuse(data, 1));
    data.environments = {even_sky({3, 3, 3}, {{0, 2, 0}, {0, 0, 0.5f}, {4, 0, 0}})};
    const Scene scene(data);
    double sum = 0;
    constexpr std::uint32_t n = 1 << 16;
    for (std::uint32_t i = 0; i < n; ++i) {
        Samples samples(6, i);
        const float choice = samples.next();
        const Vec2 where = samples.next_2d();
        const auto emission = scene.lights().emit(choice, where, samples.next_2d());
        ASSERT_TRUE(emission);
        sum += emission->flux.g;
        if (!(emission->flux.g > 0)) continue;
        EXPECT_LT(emission->direction.y, 0);
        const Vec3 in = emission->origin + emission->direction * emission->free;
        EXPECT_NEAR(in.y, 2, 1e-4f);
    }
    EXPECT_NEAR(sum / n / (std::numbers::pi * 2 * 3), 1, 0.01);
}

TEST(Portal, LetsInWhatItShowsOfAMap) {
    SceneData data;
    add(data, quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}), diffuse(data, 1));
    data.environments = {map_of_sky({{0, 2, 0}, {0, 0, 0.5f}, {4, 0, 0}})};
    const Scene scene(data);
    const double expected = mean_shown(scene, 500, [](Vec3 up) { return Vec3{2, 2, 0.25f} - up; });
    double sum = 0;
    constexpr std::uint32_t n = 1 << 17;
    for (std::uint32_t i = 0; i < n; ++i) {
        Samples samples(6, i);
        const float choice = samples.next();
        const Vec2 where = samples.next_2d();
        const auto emission = scene.lights().emit(choice, where, samples.next_2d());
        sum += emission ? emission->flux.b : 0;
    }
    EXPECT_NEAR(sum / n / (expected * std::numbers::pi * 2), 1, 0.01);
}

}  // namespace
}  // namespace lightnet::portals_test
