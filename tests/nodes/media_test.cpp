// Operators of light at points in space.
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/math/sampling.hpp"
#include "tests/support/rig.hpp"
#include "tests/support/small_media.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::media_nodes_test {
namespace {

using namespace test;

// Fills a cube around the origin, two metres wide.
Medium lumps_in_the_middle(float extinction) {
    Medium medium = lumps(extinction, 1);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        medium.extinction.to_grid.m[axis][axis] = 0.5;
        medium.extinction.to_grid.m[axis][3] = 0.5;
    }
    return medium;
}

// A ball of fog before a white sky; its surface is nothing, or glass.
SceneData ball_of(const Medium& medium, AnyMaterial surface = NoMaterial{}) {
    SceneData data;
    data.environments.push_back({{1, 1, 1}});
    data.film.width = data.film.height = 24;
    data.camera = camera({0, 0, 4}, {0, 0, 0}, 25);
    data.camera_given = true;
    data.media.push_back(medium);
    add(data, ball({0, 0, 0}, 1), material(data, std::move(surface))).media = MediumSides{0, Query::no_medium};
    return data;
}

// What loses no light is as bright as the sky around it. The bound is four standard deviations of the mean.
TEST(WhiteFog, CanNotBeSeenBeforeAWhiteSky) {
    DielectricMaterial glass;
    for (const SceneData& data : {ball_of(fog({2, 2, 2}, {1, 1, 1})), ball_of(fog({0.5f, 2, 4}, {1, 1, 1}, 0.7f)),
                                  ball_of(lumps_in_the_middle(4)), ball_of(fog({1, 1, 1}, {1, 1, 1}), glass)}) {
        const Scene scene(data);
        Rig rig(scene);
        const auto [mean, error] = measure(*rig.path_tracer(), 24, 32);
        EXPECT_NEAR(mean, 1, 4 * error + 1e-3);
        EXPECT_LT(error, 0.02);
        rig.add("PathTracing", "all", {}, {{"paths", Value{std::string("all")}}});
        const auto whole = measure(*rig.renderer("all"), 24, 32);
        EXPECT_NEAR(whole.mean, 1, 4 * whole.error + 1e-3) << "all paths at once";
    }
}

// ∫ over the ray of σ_s p(θ) I / d² × exp(-σ_t (t + d)) dt, with the eye and a point light in the fog.
TEST(Fog, AroundAPointLightIsAsBrightAsOneScatteringSays) {
    constexpr float extinction = 0.3f, albedo = 0.6f, g = 0.4f;
    SceneData data;
    data.media.push_back(fog({extinction, extinction, extinction}, {albedo, albedo, albedo}, g));
    data.around = 0;
    data.lights.push_back(PointLight{{0, 1, 0}, {5, 5, 5}});
    data.film.width = data.film.height = 32;
    data.camera = camera({0, 0, 3}, {0, 0, 0}, 0.02f);
    data.camera_given = true;
    const Scene scene(data);
    Rig rig(scene);
    rig.add("DirectLighting", "direct");
    const auto [mean, error] = measure(*rig.renderer("direct"), 32, 64);
    double expected = 0;
    constexpr int steps = 200000;
    constexpr double end = 60;
    for (int i = 0; i < steps; ++i) {
        const double t = (i + 0.5) * end / steps, z = 3 - t, d = std::sqrt(1 + z * z);
        // light goes from (0, 1, 0) to (0, 0, z), and on to the eye, along +z
        const double cosine = z / d;
        expected += extinction * albedo * data.media[0].phase.density(float(cosine)) * 5 / (d * d) *
                    std::exp(-extinction * (t + d)) * end / steps;
    }
    EXPECT_NEAR(mean, expected, 4 * error + 1e-4 * expected);
    EXPECT_LT(error, 0.02 * expected);
}

// Fog that only absorbs dims what lies behind it, and shadow rays.
TEST(Fog, ThatOnlyAbsorbsDimsLightOnItsWayThereAndBack) {
    SceneData data;
    add(data, quad({-50, 0, -50}, {0, 0, 100}, {100, 0, 0}), diffuse(data, 0.6f));
    data.lights.push_back(DirectionalLight{{0, -1, 0}, {2, 2, 2}});
    data.media.push_back(fog({0.5f, 0.5f, 0.5f}, {0, 0, 0}));
    // a slab between 1 and 2 m above the floor, which light passes twice
    Mesh slab = room();
    for (Vec3& p : slab.positions) p = Vec3{p.x * 80 - 40, p.y + 1, p.z * 80 - 40};
    slab.flip_normals = !slab.flip_normals;
    add(data, slab, material(data, NoMaterial{})).media = MediumSides{0, Query::no_medium};
    data.camera = camera({0.01f, 5, 0}, {0, 0, 0}, 0.1f);
    data.camera_given = true;
    const Scene scene(data);
    Rig rig(scene);
    rig.add("DirectLighting", "direct");
    const auto [mean, error] = measure(*rig.renderer("direct"), 4, 16);
    EXPECT_NEAR(mean, 0.6 * 2 / pi * std::exp(-1.0), 1e-3);
}

}  // namespace
}  // namespace lightnet::media_nodes_test
