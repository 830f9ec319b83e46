#include <gtest/gtest.h>

#include "core/base/math/samples.hpp"
#include "core/base/math/sampling.hpp"
#include "core/scene/scene.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::surface_test {
namespace {

using namespace test;

TEST(Surface, LiesWhereTheRayEnded) {
    SceneData data;
    const auto grey = diffuse(data, 0.5f);
    add(data, ball({1, 2, 3}, 2), grey);
    add(data, quad({-5, -5, -1}, {10, 0, 1}, {0, 10, 0}), grey);
    const Scene scene(data);
    for (std::uint32_t i = 0; i < 2000; ++i) {
        const Ray ray{{0, 0, 10}, normalize(sphere(Samples(1, i).next_2d()) * 0.4f + Vec3{0, 0, -1})};
        const auto hit = scene.intersect(ray);
        if (!hit) continue;
        const SurfacePoint point = scene.surface(*hit);
        EXPECT_NEAR(length(point.position - (ray.origin + ray.direction * hit->distance)), 0, 1e-5f);
        EXPECT_NEAR(length(point.normal), 1, 1e-6f);
        EXPECT_EQ(point.geometry, hit->geometry);
    }
}

TEST(Surface, IsTheSameFromAHitAndFromAQuestion) {
    SceneData data;
    add(data, ball({1, 2, 3}, 2), diffuse(data, 0.5f));
    const Scene scene(data);
    const auto hit = scene.intersect({{1.5f, 2, 10}, {0, 0, -1}});
    ASSERT_TRUE(hit);
    const SurfacePoint here = scene.surface(*hit);
    const SurfacePoint there = scene.surface(Query{
        .instance = hit->instance, .geometry = hit->geometry, .primitive = hit->primitive, .u = hit->u, .v = hit->v});
    EXPECT_EQ(here.position, there.position);
    EXPECT_EQ(here.normal, there.normal);
    EXPECT_EQ(here.shading.x, there.shading.x);
}

TEST(Surface, FlippedShapesTurnTheirNormalsRound) {
    SceneData data;
    const auto grey = diffuse(data, 0.5f);
    Mesh mesh = quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    add(data, mesh, grey);
    mesh.flip_normals = true;
    add(data, mesh, grey);
    Sphere inwards = ball({0, 0, 0}, 1);
    inwards.flip_normals = true;
    add(data, inwards, grey);
    const Scene scene(data);
    EXPECT_EQ(scene.surface(Hit{.geometry = 0}).normal, (Vec3{0, 0, 1}));
    EXPECT_EQ(scene.surface(Hit{.geometry = 1}).normal.z, -1);
    EXPECT_EQ(scene.surface(Hit{.geometry = 2}).normal.z, -1);
}

TEST(Surface, ShadingNormalsDecideWhichSideIsOutside) {
    SceneData data;
    Mesh mesh = quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    mesh.normals = {{0.1f, 0, -1}, {0, 0.1f, -1}, {0, 0, -1}, {0, 0, -1}};
    add(data, mesh, diffuse(data, 0.5f));
    const Scene scene(data);
    const SurfacePoint point = scene.surface(Hit{.u = 0.3f, .v = 0.3f});
    EXPECT_EQ(point.normal.z, -1);
    EXPECT_LT(point.shading.z.z, -0.9f);
    EXPECT_GT(point.shading.z.x, 0);
}

TEST(Surface, GroovesFollowTheTextureCoordinates) {
    SceneData data;
    ConductorMaterial brushed;
    brushed.metal.reflectance = colour(data, {0.9f, 0.9f, 0.9f});
    brushed.roughness.u = 0.1f;
    brushed.roughness.v = 0.4f;
    Mesh mesh = quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    mesh.uvs = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};  // u runs along y
    add(data, mesh, material(data, brushed));
    const Scene scene(data);
    const SurfacePoint point = scene.surface(Hit{.u = 0.2f, .v = 0.2f});
    EXPECT_NEAR(point.shading.x.y, 1, 1e-6f);
    EXPECT_NEAR(length(cross(point.shading.x, point.shading.y) - point.shading.z), 0, 1e-6f);
}

TEST(Surface, BallsHaveTextureCoordinatesFromPoleToPole) {
    SceneData data;
    ImageTexture picture;
    picture.image = std::make_shared<const Image>(1, 1, std::vector<Rgb>{{1, 1, 1}});
    data.textures.emplace_back().pattern = picture;
    add(data, ball({0, 0, 0}, 1), material(data, DiffuseMaterial{}));
    const Scene scene(data);
    const auto uv_at = [&](Vec3 direction) { return scene.surface(*scene.intersect({direction * 3, -direction})).uv; };
    EXPECT_NEAR(uv_at({0, 0, 1}).y, 1, 1e-3f);
    EXPECT_NEAR(uv_at({0, 0, -1}).y, 0, 1e-3f);
    EXPECT_NEAR(uv_at({0, 1, 0}).x, 0.25f, 1e-5f);
    EXPECT_NEAR(uv_at({0, -1, 0}).x, 0.75f, 1e-5f);
}

}  // namespace
}  // namespace lightnet::surface_test
