// The camera of scenes that have none.
#include "core/scene/camera_in.hpp"

#include <gtest/gtest.h>

#include "core/scene/scene.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::camera_in_test {
namespace {

Vec3 eye_of(const CameraData& camera) { return transform_point(camera.to_world, {0, 0, 0}); }

bool inside(const Box& box, Vec3 p) {
    return p.x > box.low.x && p.y > box.low.y && p.z > box.low.z && p.x < box.high.x && p.y < box.high.y &&
           p.z < box.high.z;
}

SceneData without_camera() {
    SceneData data = test::furnace(0.5f, 1);
    data.camera_given = false;
    data.camera = {};
    return data;
}

TEST(CameraIn, StandsInARoomThatIsClosedAroundItsMiddle) {
    const Scene scene(without_camera());
    EXPECT_TRUE(inside(scene.bounds(), eye_of(camera_in(without_camera(), 64, 64))));
}

TEST(CameraIn, StandsOutsideOfAThingWhoseFrontsAreOutside) {
    SceneData data = without_camera();
    auto& walls = std::get<Mesh>(data.shapes[0].geometry);
    for (auto& triangle : walls.triangles) std::swap(triangle[1], triangle[2]);
    const Scene scene(without_camera());
    EXPECT_FALSE(inside(scene.bounds(), eye_of(camera_in(data, 64, 64))));
}

TEST(CameraIn, StandsOutsideOfARoomThatIsOpen) {
    SceneData data = without_camera();
    auto& walls = std::get<Mesh>(data.shapes[0].geometry);
    walls.triangles.resize(walls.triangles.size() - 2);
    const Scene scene(without_camera());
    EXPECT_FALSE(inside(scene.bounds(), eye_of(camera_in(data, 64, 64))));
}

TEST(CameraIn, IsTheOneThatTheSceneGives) {
    const SceneData data = test::furnace(0.5f, 1);
    EXPECT_EQ(camera_in(data, 64, 64).to_world, data.camera.to_world);
}

// Whoever asks what the scene was made of, as SurfaceFact does, finds the camera that makes the picture.
TEST(CameraIn, IsThatOfTheScenesData) {
    const Scene scene(without_camera());
    EXPECT_EQ(scene.data().camera.to_world, camera_in(without_camera(), 512, 512).to_world);
    EXPECT_EQ(eye_of(scene.data().camera), scene.camera().ray(1, 1).origin);
}

}  // namespace
}  // namespace lightnet::camera_in_test
