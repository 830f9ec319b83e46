// Lights without extent, the power of all lights, and choosing among many.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/math/samples.hpp"
#include "core/base/math/sampling.hpp"
#include "core/scene/bare_lights/bare_light.hpp"
#include "core/scene/direct_light.hpp"
#include "core/scene/lamps/light_tree.hpp"
#include "core/scene/lamps/lights.hpp"
#include "core/scene/scene.hpp"
#include "core/scene/shapes/placed_quadric.hpp"
#include "tests/support/both_ways.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::bare_lights_test {
namespace {

using namespace test;

constexpr std::uint32_t many = 1 << 14;

struct Estimate {
    double mean = 0, error = 0;
};
template <class Function>
Estimate estimate(std::uint32_t n, Function value) {
    double sum = 0, squares = 0;
    for (std::uint32_t i = 0; i < n; ++i) {
        const double v = value(i);
        sum += v;
        squares += v * v;
    }
    const double mean = sum / n;
    return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean) / n)};
}

// Light that the middle of a white floor at y = 0 reflects straight up: its irradiance over π.
Estimate reflected(const Scene& scene, std::uint32_t n = many) {
    const SurfacePoint point = scene.surface(Query{.primitive = 0, .u = 0, .v = 0.5f});
    const Bsdf bsdf = scene.bsdf(point);
    return estimate(n, [&](std::uint32_t i) { return double{both_ways(scene, point, bsdf, Samples(4, i)).g}; });
}

SceneData white_floor() {
    SceneData data;
    add(data, quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}), diffuse(data, 1));
    return data;
}

TEST(PointLight, LightsByTheSquareOfItsDistance) {
    SceneData data = white_floor();
    data.lights.push_back(PointLight{{3, 4, 0}, {50, 50, 50}});
    EXPECT_NEAR(reflected(Scene(data), 16).mean, 50.0 / 25 * (4.0 / 5) / std::numbers::pi, 1e-5);
}

TEST(PointLight, CastsASharpShadow) {
    SceneData data = white_floor();
    data.lights.push_back(PointLight{{3, 4, 0}, {50, 50, 50}});
    add(data, ball({1.5f, 2, 0}, 0.2f), diffuse(data, 0));
    EXPECT_EQ(reflected(Scene(data), 16).mean, 0);
}

TEST(DirectionalLight, LightsByItsCosine) {
    SceneData data = white_floor();
    data.lights.push_back(DirectionalLight{normalize({1, -2, 0}), {3, 3, 3}});
    EXPECT_NEAR(reflected(Scene(data), 16).mean, 3 * 2 / std::sqrt(5.0) / std::numbers::pi, 1e-5);
    add(data, quad({-100, 50, -100}, {200, 0, 0}, {0, 0, 200}), diffuse(data, 0));
    EXPECT_EQ(reflected(Scene(data), 16).mean, 0);  // hidden, however far away
}

TEST(SpotLight, FallsOffAsItSays) {
    using Falloff = SpotLight::Falloff;
    const float inner = 0.3f, outer = 0.5f;
    for (const auto falloff : {Falloff::smoothstep, Falloff::linear, Falloff::squared_linear}) {
        const SpotLight spot{{0, 0, 0}, {0, 0, 1}, {1, 1, 1}, inner, outer, falloff};
        EXPECT_EQ(spot.share_at(std::cos(0.29f)), 1);
        EXPECT_EQ(spot.share_at(std::cos(0.51f)), 0);
    }
    const auto at = [&](Falloff falloff, float angle) {
        return SpotLight{{0, 0, 0}, {0, 0, 1}, {1, 1, 1}, inner, outer, falloff}.share_at(std::cos(angle));
    };
    const double t = (std::cos(0.4) - std::cos(0.5)) / (std::cos(0.3) - std::cos(0.5));
    EXPECT_NEAR(at(Falloff::linear, 0.4f), 0.5, 1e-4);
    EXPECT_NEAR(at(Falloff::smoothstep, 0.4f), t * t * (3 - 2 * t), 1e-4);
    EXPECT_NEAR(at(Falloff::squared_linear, 0.4f), t * t, 1e-4);
}

TEST(SpotLight, LightsWhatItIsTurnedTo) {
    SceneData data = white_floor();
    data.lights.push_back(SpotLight{{3, 4, 0}, normalize({-3, -4, 0}), {50, 50, 50}, 0.1f, 0.2f});
    EXPECT_NEAR(reflected(Scene(data), 16).mean, 50.0 / 25 * (4.0 / 5) / std::numbers::pi, 1e-5);
    std::get<SpotLight>(data.lights[0]).axis = {0, -1, 0};
    EXPECT_EQ(reflected(Scene(data), 16).mean, 0);
}

// All flux through a sphere around the light, by what its points receive.
Estimate flux_received(const Scene& scene, float radius) {
    return estimate(1 << 17, [&](std::uint32_t i) {
        Samples samples(5, i);
        const Vec3 outwards = sphere(samples.next_2d());
        const float choice = samples.next();
        const auto sample = scene.lights().sample(LitPoint(outwards * radius), choice, samples.next_2d());
        if (!sample) return 0.0;
        const double cosine = std::max(0.0f, -dot(sample->direction, outwards));
        return sample->radiance.g * cosine / sample->pdf * 4 * std::numbers::pi * radius * radius;
    });
}

Estimate flux_emitted(const Scene& scene) {
    return estimate(1 << 17, [&](std::uint32_t i) {
        Samples samples(6, i);
        const float choice = samples.next();
        const Vec2 where = samples.next_2d();
        const auto emission = scene.lights().emit(choice, where, samples.next_2d());
        return emission ? double{emission->flux.g} : 0.0;
    });
}

void expect_power(const SceneData& data, double power, float radius = 4) {
    const Scene scene(data);
    const auto emitted = flux_emitted(scene), received = flux_received(scene, radius);
    EXPECT_NEAR(emitted.mean / power, 1, 4 * emitted.error / power + 1e-4);
    EXPECT_NEAR(received.mean / power, 1, 4 * received.error / power + 1e-4);
    EXPECT_LT(emitted.error / power, 0.01);
    EXPECT_LT(received.error / power, 0.01);
}

SceneData shining(ShapeGeometry shape, AreaEmission emission) {
    SceneData data;
    add(data, std::move(shape), diffuse(data, 0)).emission = emission;
    return data;
}

TEST(Power, OfASquareIsPiTimesAreaTimesRadiance) {
    const Mesh square = quad({-1, -0.5f, 0}, {2, 0, 0}, {0, 1, 0});
    expect_power(shining(square, {{3, 3, 3}}), 3 * 2 * std::numbers::pi);
    expect_power(shining(square, {{3, 3, 3}, true}), 2 * 3 * 2 * std::numbers::pi);
}

TEST(Power, OfABallIsFourPiSquaredTimesRadiusSquared) {
    expect_power(shining(ball({0.3f, 0, 0}, 0.5f), {{2, 2, 2}}), 2 * std::numbers::pi * std::numbers::pi);
}

TEST(Power, OfAQuadricIsPiTimesAreaTimesRadiance) {
    for (const auto round : {Quadric::Round::disk, Quadric::Round::cylinder, Quadric::Round::sphere}) {
        Quadric shape;
        shape.round = round;
        shape.to_world.m = {{{0.5, 0.1, 0, 0.1}, {0, 0.3, 0.2, 0}, {0, -0.1, 0.4, 0}, {0, 0, 0, 1}}};
        const double area = double{PlacedQuadric(shape).area()};
        expect_power(shining(shape, {{2, 2, 2}}), 2 * area * std::numbers::pi);
    }
}

TEST(Power, OfATexturedSquareIsThatOfItsMean) {
    SceneData data = shining(quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), {{3, 3, 3}});
    auto& mesh = std::get<Mesh>(data.shapes[0].geometry);
    mesh.uvs = {{0, 0}, {2, 0}, {2, 2}, {0, 2}};
    const TextureId white = colour(data, {1, 1, 1}), black = colour(data, {0, 0, 0});
    data.textures.push_back({{1, 1, 1}, CheckerTexture{white, black, {}}});
    data.shapes[0].emission->texture = TextureId(data.textures.size() - 1);
    expect_power(data, 3 * 4 * std::numbers::pi / 2);
}

TEST(Power, OfAPointIsFourPiTimesItsIntensity) {
    SceneData data;
    data.lights.push_back(PointLight{{0, 0.2f, 0}, {5, 5, 5}});
    expect_power(data, 5 * 4 * std::numbers::pi);
}

TEST(Power, OfASpotIsTheIntegralOfItsFalloff) {
    using Falloff = SpotLight::Falloff;
    for (const auto falloff : {Falloff::smoothstep, Falloff::linear, Falloff::squared_linear}) {
        const SpotLight spot{{0, 0, 0}, normalize({1, 2, 2}), {7, 7, 7}, 0.6f, 1.1f, falloff};
        double integral = 0;
        constexpr int n = 100000;
        for (int i = 0; i < n; ++i) integral += spot.share_at(float(-1 + (i + 0.5) * 2 / n)) * 2.0 / n;
        EXPECT_NEAR(spot.power().g / (2 * std::numbers::pi * 7 * integral), 1, 1e-4);
        SceneData data;
        data.lights.push_back(spot);
        expect_power(data, 2 * std::numbers::pi * 7 * integral);
    }
}

TEST(Power, FromInfinityIsWhatMeetsTheBallAroundTheScene) {
    SceneData data = white_floor();
    data.lights.push_back(DirectionalLight{{0, -1, 0}, {3, 3, 3}});
    const Scene sun(data);
    const double disk = std::numbers::pi * sun.radius() * sun.radius();
    EXPECT_NEAR(flux_emitted(sun).mean / (3 * disk), 1, 1e-4);
    data.lights.clear();
    data.environments.push_back({{2, 2, 2}});
    EXPECT_NEAR(flux_emitted(Scene(data)).mean / (2 * 4 * std::numbers::pi * disk), 1, 1e-4);
}

TEST(Power, LeavesEachLightByItsShare) {
    SceneData data = shining(quad({-1, -0.5f, 0}, {2, 0, 0}, {0, 1, 0}), {{3, 3, 3}, true});
    add(data, ball({2, 0, 0}, 0.5f), diffuse(data, 0)).emission = AreaEmission{{0.1f, 1, 9}};
    data.lights.push_back(PointLight{{0, 2, 0}, {5, 1, 5}});
    data.lights.push_back(SpotLight{{0, -2, 0}, {0, 1, 0}, {5, 2, 5}, 0.1f, 0.4f});
    const double power = 12 * std::numbers::pi + std::numbers::pi * std::numbers::pi + 4 * std::numbers::pi +
                         std::get<SpotLight>(data.lights[1]).power().g;
    const auto emitted = flux_emitted(Scene(data));
    EXPECT_NEAR(emitted.mean, power, 4 * emitted.error);
}

// Little lamps everywhere, of all kinds.
SceneData lamps(std::uint32_t count) {
    SceneData data = white_floor();
    const auto black = diffuse(data, 0);
    for (std::uint32_t i = 0; i < count; ++i) {
        Samples samples(7, i);
        const Vec2 at = samples.next_2d();
        const Vec3 place{8 * at.x - 4, 0.3f + 3 * samples.next(), 8 * at.y - 4}, turn = sphere(samples.next_2d());
        const float watts = 0.2f + 5 * samples.next();
        const Rgb light{watts, watts, watts};
        switch (i % 4) {
            case 0:
                add(data, ball(place, 0.05f), black).emission = AreaEmission{light * 40};
                break;
            case 1: {
                const Frame f = Frame::around(turn);
                add(data, quad(place, f.x * 0.2f, f.y * 0.1f), black).emission = AreaEmission{light * 20, i % 8 == 1};
                break;
            }
            case 2:
                data.lights.push_back(PointLight{place, light * 0.2f});
                break;
            default:
                data.lights.push_back(SpotLight{place, turn, light, 0.3f, 0.9f});
        }
    }
    return data;
}

// The sum of what each lamp sends alone, the others being as black as they look, is what all send together.
TEST(ManyLights, LightAsMuchTogetherAsOneByOne) {
    const SceneData data = lamps(40);
    double expected = 0, variance = 0;
    const auto add_scene = [&](const SceneData& alone) {
        const auto [mean, error] = reflected(Scene(alone), 1 << 12);
        expected += mean;
        variance += error * error;
    };
    for (std::size_t s = 1; s < data.shapes.size(); ++s) {
        SceneData alone = data;
        alone.lights.clear();
        for (std::size_t other = 1; other < data.shapes.size(); ++other)
            if (other != s) alone.shapes[other].emission.reset();
        add_scene(alone);
    }
    for (const auto& light : data.lights) {
        SceneData alone = data;
        alone.lights = {light};
        for (auto& shape : alone.shapes) shape.emission.reset();
        add_scene(alone);
    }
    const auto together = reflected(Scene(data), 1 << 17);
    EXPECT_NEAR(together.mean, expected, 4 * std::sqrt(together.error * together.error + variance));
    EXPECT_LT(together.error / together.mean, 0.005);
}

TEST(ManyLights, BearLampsWithoutAPlace) {
    SceneData data = lamps(8);
    Mesh lost = quad({std::nanf(""), 1, 0}, {1, 0, 0}, {0, 0, 1});
    add(data, lost, diffuse(data, 0)).emission = AreaEmission{{1, 1, 1}};
    add(data, quad({0, 1, 0}, {1, 0, 0}, {2, 0, 0}), diffuse(data, 0)).emission = AreaEmission{{1, 1, 1}};  // no area
    data.lights.push_back(PointLight{{0, 1, 0}, {0, 0, 0}});
    data.lights.push_back(SpotLight{{0, 1, 0}, {0, -1, 0}, {1, 1, 1}, 0.4f, 0.4f});
    const auto light = reflected(Scene(data));
    EXPECT_TRUE(std::isfinite(light.mean));
    EXPECT_GT(light.mean, 0);
    EXPECT_TRUE(std::isfinite(flux_emitted(Scene(data)).mean));
}

}  // namespace
}  // namespace lightnet::bare_lights_test
