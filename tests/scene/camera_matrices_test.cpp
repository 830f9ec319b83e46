#include "core/scene/camera/camera_matrices.hpp"

#include <gtest/gtest.h>

#include "core/scene/camera/camera.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::camera_matrices_test {
namespace {

void expect_same_places(const CameraData& data) {
    const Camera camera(data, 80, 60);
    const auto matrices = matrices_of(data, 80, 60);
    for (const Vec3 p : {Vec3{0, 0, 0}, Vec3{1, 2, -3}, Vec3{-2, 0.5f, 1}}) {
        const Vec3 seen = camera.project(p);
        const Vec3 ndc = transform_point(matrices.to_ndc.value(), p);
        EXPECT_NEAR(ndc.x * 80, seen.x / seen.z, 1e-3);
        EXPECT_NEAR(ndc.y * 60, seen.y / seen.z, 1e-3);
    }
    const Ray ray = camera.ray(40, 30);
    const Vec3 ahead = transform_point(matrices.to_camera, ray.origin + ray.direction * 3);
    EXPECT_NEAR(ahead.z, 3, 1e-4) << "z is the depth";
}

TEST(CameraMatrices, TakePointsToWhereTheCameraSeesThem) {
    expect_same_places(test::camera({3, 4, 8}, {0, 1, 0}, 35));
    CameraData flat = test::camera({3, 4, 8}, {0, 1, 0}, 35);
    flat.projection = Orthographic{};
    flat.screen_given = true;
    flat.screen = {-4, 4, -3, 3};
    expect_same_places(flat);
}

TEST(CameraMatrices, OfPanoramasAreThoseOfTheCameraAlone) {
    CameraData around = test::camera({3, 4, 8}, {0, 1, 0}, 35);
    around.projection = EqualArea{};
    EXPECT_FALSE(matrices_of(around, 80, 80).to_ndc.has_value());
}

}  // namespace
}  // namespace lightnet::camera_matrices_test
