#include <gtest/gtest.h>

#include <array>
#include <map>

#include "core/base/math/samples.hpp"
#include "core/base/math/sampling.hpp"
#include "core/scene/direct_light.hpp"
#include "core/scene/lamps/lights.hpp"
#include "core/scene/scene.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::lights_test {
namespace {

using namespace test;

constexpr std::uint32_t many = 1 << 14;

std::optional<LightSample> draw(const Scene& scene, Vec3 from, std::uint32_t i) {
    Samples samples(1, i);
    const float choice = samples.next();
    return scene.lights().sample(LitPoint(from), choice, samples.next_2d());
}

// The mean of 1/density is the solid angle that all lamps fill.
double solid_angle(const Scene& scene, Vec3 from) {
    double sum = 0;
    for (std::uint32_t i = 0; i < many; ++i)
        if (const auto lamp = draw(scene, from, i)) sum += 1 / lamp->pdf;
    return sum / many;
}

Scene one_lamp(ShapeGeometry geometry, bool two_sided = false) {
    SceneData data;
    add(data, std::move(geometry), diffuse(data, 0)).emission = AreaEmission{{1, 1, 1}, two_sided};
    return Scene(std::move(data));
}

TEST(Lights, FillTheSolidAngleOfASquare) {
    const Scene scene = one_lamp(quad({-1, -1, 2}, {0, 2, 0}, {2, 0, 0}));
    // 4 asin(a b / sqrt((a² + d²)(b² + d²))) for half sides a, b and distance d
    EXPECT_NEAR(solid_angle(scene, {0, 0, 0}), 4 * std::asin(1.0 / 5), 2e-3);
    EXPECT_NEAR(solid_angle(scene, {0, 0, 1}), 4 * std::asin(1.0 / 2), 5e-3);
    EXPECT_EQ(solid_angle(scene, {0, 0, 3}), 0);  // behind it
}

// A parallelogram is sampled as one, however its halves are cut and written; other pairs of triangles are not.
TEST(Lights, FillASquareHoweverItsHalvesAreWritten) {
    Mesh square;
    square.positions = {{-1, -1, 2}, {-1, 1, 2}, {1, 1, 2}, {1, -1, 2}};
    const std::array<std::array<std::uint32_t, 3>, 2> cuts[2] = {{{{0, 1, 2}, {0, 2, 3}}}, {{{0, 1, 3}, {1, 2, 3}}}};
    for (const auto& [first, second] : cuts)
        for (std::uint32_t i = 0; i < 9; ++i) {
            const auto turned = [](const std::array<std::uint32_t, 3>& t, std::uint32_t by) {
                return std::array{t[by % 3], t[(by + 1) % 3], t[(by + 2) % 3]};
            };
            square.triangles = {turned(first, i / 3), turned(second, i % 3)};
            const Scene scene = one_lamp(square);
            ASSERT_NEAR(solid_angle(scene, {0, 0, 0}), 4 * std::asin(1.0 / 5), 2e-3);
            Vec3 mean;
            for (std::uint32_t k = 0; k < 1024; ++k) {
                const Vec3 at = draw(scene, {0, 0, 0}, k)->position;
                ASSERT_LE(std::max(std::fabs(at.x), std::fabs(at.y)), 1.00001f);
                mean += at * (1 / 1024.0f);
            }
            ASSERT_NEAR(length(mean - Vec3{0, 0, 2}), 0, 5e-3f);
        }
}

TEST(Lights, FillTwoTrianglesThatAreNoParallelogram) {
    Mesh kite;
    kite.positions = {{-1, -1, 2}, {-1, 1, 2}, {1, 1, 2}, {2, -2, 2}};
    kite.triangles = {{0, 1, 2}, {0, 2, 3}};
    const auto half = [&](std::uint32_t i) {
        Mesh triangle = kite;
        triangle.triangles = {kite.triangles[i]};
        return solid_angle(one_lamp(triangle), {0, 0, 0});
    };
    EXPECT_NEAR(solid_angle(one_lamp(kite), {0, 0, 0}) / (half(0) + half(1)), 1, 1e-2);
}

TEST(Lights, FillTheSolidAngleOfABallHoweverSmall) {
    for (const float radius : {1e-3f, 0.03f, 0.5f, 1.9f}) {
        const Scene scene = one_lamp(ball({0, 2, 0}, radius));
        const double sine2 = radius * radius / 4.0;
        EXPECT_NEAR(solid_angle(scene, {0, 0, 0}) / (2 * pi * sine2 / (1 + std::sqrt(1 - sine2))), 1, 1e-4);
    }
}

TEST(Lights, FillAllDirectionsInsideABall) {
    Sphere inwards = ball({0, 0, 0}, 2);
    inwards.flip_normals = true;
    const Scene scene = one_lamp(inwards);
    EXPECT_NEAR(solid_angle(scene, {0.5f, 0.3f, 0}), 4 * pi, 2e-2);
    EXPECT_EQ(solid_angle(one_lamp(ball({0, 0, 0}, 2)), {0.5f, 0.3f, 0}), 0);  // shines outwards only
}

TEST(Lights, StateTheSameDensityForAPointHoweverItIsFound) {
    SceneData data;
    const auto black = diffuse(data, 0);
    add(data, quad({-1, -1, 2}, {0, 2, 0}, {2, 0.5f, 0}), black).emission = AreaEmission{{3, 3, 3}, false};
    add(data, ball({3, 0, 0}, 0.4f), black).emission = AreaEmission{{10, 1, 1}, false};
    add(data, room(), black);
    add(data, ball({-2, 0, -2}, 0.05f), black).emission = AreaEmission{{1, 5, 1}, true};
    const Scene scene(data);
    const Vec3 from{0.3f, -0.4f, -0.5f};
    std::size_t checked = 0;
    for (std::uint32_t i = 0; i < many; ++i) {
        const auto lamp = draw(scene, from, i);
        if (!lamp) continue;
        const auto hit = scene.intersect({from, lamp->direction});
        if (!hit) continue;
        const SurfacePoint end = scene.surface(*hit);
        if (is_black(scene.lights().emission(end, -lamp->direction)) || length(end.position - lamp->position) > 1e-3f)
            continue;
        ASSERT_NEAR(scene.lights().pdf(LitPoint(from), lamp->direction, end) / lamp->pdf, 1, 2e-2f);
        ++checked;
    }
    EXPECT_GT(checked, many / 3);
}

// From far away, and as seen under the same angle, only power counts.
TEST(Lights, AreChosenByPowerFromFarAway) {
    SceneData data;
    const auto black = diffuse(data, 0);
    add(data, quad({0, 0, 500}, {0, 1, 0}, {1, 0, 0}), black).emission = AreaEmission{{1, 1, 1}, false};
    add(data, quad({2, 0, 500}, {0, 1, 0}, {1, 0, 0}), black).emission = AreaEmission{{3, 3, 3}, false};
    add(data, quad({4, 0, 500}, {0, 2, 0}, {1, 0, 0}), black).emission = AreaEmission{{2, 2, 2}, true};
    const Scene scene(data);
    std::map<int, double> count;
    for (std::uint32_t i = 0; i < many; ++i)
        if (const auto lamp = draw(scene, {2, 0, 0}, i)) count[int(lamp->position.x / 2)] += 8.0 / many;
    EXPECT_NEAR(count[0], 1, 0.05);
    EXPECT_NEAR(count[1], 3, 0.05);
    EXPECT_NEAR(count[2], 4, 0.05);  // its other side shines elsewhere
}

TEST(Lights, NeverChooseAConstantEnvironment) {
    SceneData data;
    data.environments.push_back({{1, 2, 3}});
    const Scene scene(data);
    EXPECT_TRUE(scene.lights().has_environment());
    EXPECT_FALSE(draw(scene, {0, 0, 0}, 0));
    EXPECT_EQ(scene.lights().environment_pdf(Ray{{0, 0, 0}, {0, 0, 1}}), 0);
    EXPECT_FALSE(scene.lights().samples_environment());
    EXPECT_EQ(scene.lights().environment(Ray{{0, 0, 0}, {0, 0, 1}}), (Rgb{1, 2, 3}));
}

TEST(Lights, RuleOutOnlyRaysThatCannotMeetThem) {
    SceneData data;
    const auto black = diffuse(data, 0);
    add(data, quad({-1, -1, 2}, {0, 2, 0}, {2, 0, 0}), black).emission = AreaEmission{{1, 1, 1}, false};
    add(data, ball({3, 0, 0}, 0.4f), black).emission = AreaEmission{{1, 1, 1}, false};
    const Scene scene(data);
    std::size_t ruled_out = 0;
    for (std::uint32_t i = 0; i < many; ++i) {
        const Ray ray{{0, 0, 0}, sphere(Samples(1, i).next_2d())};
        if (scene.may_shine(ray)) continue;
        ++ruled_out;
        ASSERT_FALSE(scene.occluded(ray));
    }
    EXPECT_GT(ruled_out, many / 2);
}

TEST(Heuristics, SharesOfBothWaysAddUpToOne) {
    for (const bool squared : {false, true})
        for (const float p : {1e-20f, 1e-3f, 1.0f, 1e5f, 1e25f})
            for (const float q : {1e-3f, 2.0f, 1e4f})
                EXPECT_NEAR(share(squared, p, q) + share(squared, q, p), 1, 1e-6f);
    EXPECT_EQ(share(true, 0.5f, 0), 1);
}

}  // namespace
}  // namespace lightnet::lights_test
