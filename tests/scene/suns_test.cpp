// Directional lights that fill a cone of directions.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/base/math/samples.hpp"
#include "core/base/math/sampling.hpp"
#include "core/scene/direct_light.hpp"
#include "core/scene/lamps/lights.hpp"
#include "core/scene/scene.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::suns_test {
namespace {

using namespace test;

constexpr double turn = 2 * std::numbers::pi;

struct Found {
    double mean = 0, error = 0;
};

SceneData floor_of(std::uint32_t (*make)(SceneData&)) {
    SceneData data;
    add(data, quad({-50, 0, -50}, {0, 0, 100}, {100, 0, 0}), make(data));
    return data;
}
SceneData white_plain() {
    return floor_of([](SceneData& data) { return diffuse(data, 1); });
}

DirectionalLight sun(Vec3 towards, float irradiance, float half_angle) {
    return {normalize(-towards), {irradiance, irradiance, irradiance}, {}, half_angle};
}

/// What the floor at `at` sends to `outgoing`, a half of all samples by points on lamps and one by directions.
Found sent(const Scene& scene, Vec3 outgoing, Heuristic heuristic, Vec3 at = {}, std::uint32_t samples = 1 << 15) {
    const auto hit = scene.intersect({at + Vec3{0, 0.01f, 0}, {0, -1, 0}});
    const SurfacePoint point = scene.surface(*hit);
    const Bsdf bsdf = scene.bsdf(point);
    const Gathering gathering{point, bsdf, outgoing, lobe::all};
    double sum = 0, squares = 0;
    for (std::uint32_t i = 0; i < samples; ++i) {
        Samples numbers(5, i);
        const float choice = numbers.next();
        double light = 0;
        if (const auto lamp = ray_to_lamp(scene, gathering, {choice, numbers.next_2d()}, heuristic))
            if (!scene.occluded(lamp->ray)) light += double{lamp->light.g};
        if (const auto way = bsdf.sample(outgoing, numbers.next(), numbers.next_2d(), lobe::all))
            if (!scene.occluded({point.origin_towards(way->incoming), way->incoming}))
                light += double{(way->weight * light_by_bsdf(scene, lit_point(gathering), *way, nullptr, heuristic)).g};
        sum += light;
        squares += light * light;
    }
    const double mean = sum / samples;
    return {mean, std::sqrt(std::max(0.0, squares / samples - mean * mean) / samples)};
}
Found reflected(const SceneData& data, Vec3 at = {}) { return sent(Scene(data), {0, 1, 0}, Heuristic::power, at); }

// While all of it is above the horizon, a disk of even radiance lights a plane by the cosine of its middle, exactly.
TEST(Sun, LightsAPlaneAsItsMiddleAloneWould) {
    for (const float half_angle : {0.0046531f, 0.1f, 0.6f}) {
        SceneData data = white_plain();
        data.lights.push_back(sun({1, 2, -1}, 3, half_angle));
        const auto [mean, error] = reflected(data);
        const double exact = 3 * 2 / std::sqrt(6.0) / std::numbers::pi;
        EXPECT_NEAR(mean, exact, 4 * error + 1e-5 * exact) << half_angle;
        EXPECT_LT(error, 5e-3 * exact);
    }
}

// By samples of the sun alone, by directions of the surface alone, and by both.
TEST(Sun, IsTheSameByAllWaysToFindIt) {
    for (const float roughness : {0.0f, 0.3f}) {
        SceneData data;
        ConductorMaterial metal;
        metal.metal.reflectance = colour(data, {0.8f, 0.8f, 0.8f});
        metal.roughness.u = metal.roughness.v = roughness;
        add(data, quad({-50, 0, -50}, {0, 0, 100}, {100, 0, 0}),
            roughness > 0 ? material(data, metal) : diffuse(data, 1));
        data.lights.push_back(sun({-0.8f, 1, 0}, 2, 0.25f));
        data.lights.push_back(DirectionalLight{{0, -1, 0}, {0.1f, 0.1f, 0.1f}});
        data.environments.push_back({{0.1f, 0.1f, 0.1f}});
        const Scene scene(data);
        const Vec3 outgoing = normalize({1, 1, 0});
        const auto shared = sent(scene, outgoing, Heuristic::power);
        for (const auto heuristic : {Heuristic::balance, Heuristic::lamps, Heuristic::directions}) {
            const auto [mean, error] = sent(scene, outgoing, heuristic);
            EXPECT_NEAR(mean, shared.mean, 4 * std::hypot(error, shared.error)) << int(heuristic) << ' ' << roughness;
            EXPECT_LT(error, 0.05 * mean);
        }
        EXPECT_LT(shared.error, 0.02 * shared.mean);
    }
}

// Below an edge at the height h, the part of the disk that is seen is a segment: none of it h tan(angle) inwards of the
// edge, all of it as far outwards.
TEST(Sun, CastsAPenumbraAsWideAsItsAngle) {
    const float half_angle = 0.03f, height = 2, reach = height * std::tan(half_angle);
    SceneData data = white_plain();
    data.lights.push_back(sun({0, 1, 0}, 1, half_angle));
    add(data, quad({0, height, -40}, {0, 0, 80}, {40, 0, 0}), diffuse(data, 0));
    for (const float t : {-1.02f, -0.9f, -0.5f, 0.0f, 0.5f, 0.9f, 1.02f}) {
        const auto [mean, error] = reflected(data, {t * reach, 0, 0.3f});
        const double inside = std::clamp(double{t}, -1.0, 1.0);
        const double seen = (std::acos(inside) - inside * std::sqrt(1 - inside * inside)) / std::numbers::pi;
        EXPECT_NEAR(mean * std::numbers::pi, seen, 4 * error * std::numbers::pi + 1e-3) << t;
    }
}

TEST(Sun, IsMetByRaysIntoItsConeAlone) {
    SceneData data = white_plain();
    const float half_angle = 0.0046531f;
    data.lights.push_back(sun({0, 0, 1}, 1, half_angle));
    const Scene scene(data);
    EXPECT_TRUE(scene.lights().has_suns());
    EXPECT_FALSE(scene.lights().has_environment());
    const double solid_angle = turn * 2 * std::pow(std::sin(double{half_angle} / 2), 2);
    for (const float part : {0.0f, 0.7f, 0.999f}) {
        const auto seen = scene.lights().sun({std::sin(part * half_angle), 0, std::cos(part * half_angle)});
        ASSERT_TRUE(seen) << part;
        EXPECT_NEAR(double{seen->light.radiance.g} * std::numbers::pi * std::pow(std::sin(double{half_angle}), 2), 1,
                    1e-4);
        EXPECT_NEAR(double{seen->light.pdf} * solid_angle, 1, 1e-4);
    }
    EXPECT_FALSE(scene.lights().sun({0, std::sin(1.001f * half_angle), std::cos(1.001f * half_angle)}));
    EXPECT_FALSE(scene.lights().sun({0, 0, -1}));
    const Vec3 within{0, std::sin(0.5f * half_angle), std::cos(0.5f * half_angle)};
    EXPECT_TRUE(scene.may_shine({{0, 1, 0}, within}));
    EXPECT_FALSE(scene.may_shine({{0, 1, 0}, {1, 0, 0}}));
}

TEST(Sun, OfNoAngleIsMetByNoRay) {
    SceneData data = white_plain();
    data.lights.push_back(sun({0, 0, 1}, 1, 0));
    const Scene scene(data);
    EXPECT_FALSE(scene.lights().has_suns());
    EXPECT_FALSE(scene.lights().sun({0, 0, 1}));
}

TEST(Sun, IsSampledWithTheDensityThatItSays) {
    SceneData data = white_plain();
    data.lights.push_back(sun({0, 1, 0}, 1, 0.5f));
    data.lights.push_back(sun({0.3f, 1, 0}, 1, 0.3f));
    data.environments.push_back({{1, 1, 1}});
    const Scene scene(data);
    // A direction's share of a cell of the cone's square of directions is its density times the cell's solid angle.
    constexpr std::uint32_t samples = 1 << 16;
    constexpr int cells = 12;
    std::vector<double> counted(cells * cells), expected(cells * cells);
    const auto cell = [](Vec3 d) { return int((d.x + 1) / 2 * cells) * cells + int((d.z + 1) / 2 * cells); };
    for (std::uint32_t i = 0; i < samples; ++i) {
        Samples numbers(9, i);
        const float choice = numbers.next();
        const auto lamp = scene.lights().sample(LitPoint({0, 1, 0}), choice, numbers.next_2d());
        ASSERT_TRUE(lamp);
        const auto seen = scene.lights().sun(lamp->direction);
        ASSERT_TRUE(seen);
        EXPECT_FLOAT_EQ(seen->light.pdf, lamp->pdf);
        EXPECT_FLOAT_EQ(seen->light.radiance.g, lamp->radiance.g);
        EXPECT_FALSE(lamp->bare);
        counted[std::size_t(cell(lamp->direction))] += 1;
        const Vec3 anywhere = sphere(numbers.next_2d());
        if (const auto met = scene.lights().sun(anywhere))
            expected[std::size_t(cell(anywhere))] += double{met->light.pdf} * 2 * turn;
    }
    double total = 0;
    for (std::size_t k = 0; k < counted.size(); ++k) {
        total += expected[k] / samples;
        EXPECT_NEAR(counted[k], expected[k], 6 * std::sqrt(expected[k] * 20 + 100)) << k;
    }
    EXPECT_NEAR(total, 1, 0.02);
}

// Each lights as if it were alone, also where both are.
TEST(Suns, ThatOverlapAddUp) {
    SceneData data = white_plain();
    data.lights.push_back(sun({0, 1, 0}, 1, 0.5f));
    data.lights.push_back(sun({0.2f, 1, 0}, 2, 0.3f));
    data.lights.push_back(sun({0, 1, 0}, 0.5f, 0));
    const auto [mean, error] = reflected(data);
    EXPECT_NEAR(mean * std::numbers::pi, 1.5 + 2 / std::hypot(1.0, 0.2), 4 * error * std::numbers::pi);
    EXPECT_LT(error, 0.01);
}

TEST(Suns, AreOfTheirOwnGroups) {
    SceneData data = white_plain();
    data.groups = {"day", "sky"};
    data.environment_group = 1;
    data.environments.push_back({{1, 1, 1}});
    data.lights.push_back(sun({0, 1, 0}, 1, 0.1f));
    data.lights.push_back(sun({0, 0, 1}, 1, 0.1f));
    std::get<DirectionalLight>(data.lights[1]).label.group = 1;
    const Scene whole(data), apart(whole, {all_groups, true});
    EXPECT_EQ(whole.lights().sun({0, 1, 0})->group, 0u);
    EXPECT_EQ(whole.lights().sun({0, 0, 1})->group, 0u);
    EXPECT_EQ(apart.lights().sun({0, 1, 0})->group, 0u);
    EXPECT_EQ(apart.lights().sun({0, 0, 1})->group, 1u);
    const Scene without(whole, {GroupSet{2}, true});
    EXPECT_FALSE(without.lights().sun({0, 1, 0}));
    EXPECT_TRUE(without.lights().sun({0, 0, 1}));
}

TEST(Power, OfASunIsWhatItsConeSendsIntoTheBallAroundTheScene) {
    SceneData data = white_plain();
    const float half_angle = 0.5f;
    data.lights.push_back(sun({0, 1, 0}, 3, half_angle));
    const Scene scene(data);
    const double radiance = 3 / (std::numbers::pi * std::pow(std::sin(double{half_angle}), 2));
    const double across = std::numbers::pi * double{scene.radius()} * double{scene.radius()};
    double flux = 0, down = 0;
    constexpr std::uint32_t samples = 1 << 12;
    for (std::uint32_t i = 0; i < samples; ++i) {
        Samples numbers(3, i);
        const float choice = numbers.next();
        const Vec2 position = numbers.next_2d();
        const auto emitted = scene.lights().emit(choice, position, numbers.next_2d());
        ASSERT_TRUE(emitted);
        ASSERT_LE(-emitted->direction.y, 1);
        ASSERT_GE(-emitted->direction.y, std::cos(half_angle) - 1e-6f);
        flux += double{emitted->flux.g} / samples;
        down -= double{emitted->direction.y} / samples;
    }
    EXPECT_NEAR(flux / (radiance * turn * (1 - std::cos(double{half_angle})) * across), 1, 1e-4);
    EXPECT_NEAR(down, (1 + std::cos(double{half_angle})) / 2, 1e-3);  // the cone's mean
}

}  // namespace
}  // namespace lightnet::suns_test
