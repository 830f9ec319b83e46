#include "core/scene/camera.hpp"

#include <gtest/gtest.h>

#include "tests/support/small_scenes.hpp"

namespace lightnet {
namespace {

TEST(Camera, LooksAlongItsAxisInTheMiddleOfThePicture) {
    const Camera camera(test::camera({1, 2, 3}, {1, 2, 0}, 60), 100, 80);
    const Ray ray = camera.ray(50, 40);
    EXPECT_EQ(ray.origin, (Vec3{1, 2, 3}));
    EXPECT_NEAR(length(ray.direction - Vec3{0, 0, -1}), 0, 1e-6f);
}

TEST(Camera, OpensItsAngleAcrossTheShorterSide) {
    const CameraData data = test::camera({0, 0, 0}, {0, 0, -1}, 90);
    EXPECT_NEAR(length(Camera(data, 200, 100).ray(100, 0).direction - normalize({0, 1, -1})), 0, 1e-6f);
    EXPECT_NEAR(length(Camera(data, 200, 100).ray(200, 50).direction - normalize({2, 0, -1})), 0, 1e-6f);
    EXPECT_NEAR(length(Camera(data, 100, 200).ray(0, 100).direction - normalize({-1, 0, -1})), 0, 1e-6f);
    EXPECT_NEAR(length(Camera(data, 100, 200).ray(50, 200).direction - normalize({0, -2, -1})), 0, 1e-6f);
}

TEST(Camera, TakesAScreenThatIsGiven) {
    CameraData data = test::camera({0, 0, 0}, {0, 0, -1}, 90);
    data.screen = {0, 1, -1, 0};
    data.screen_given = true;
    const Camera camera(data, 64, 64);
    EXPECT_NEAR(length(camera.ray(0, 0).direction - Vec3{0, 0, -1}), 0, 1e-6f);
    EXPECT_NEAR(length(camera.ray(64, 64).direction - normalize({1, -1, -1})), 0, 1e-6f);
}

}  // namespace
}  // namespace lightnet
