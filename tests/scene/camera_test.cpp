#include "core/scene/camera/camera.hpp"

#include <gtest/gtest.h>

#include "core/base/math/samples.hpp"
#include "core/scene/scene.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::camera_test {
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

TEST(Camera, KnowsWhereInThePictureAPositionIs) {
    CameraData data = test::camera({1, 2, 3}, {4, 1, -2}, 50);
    for (const bool orthographic : {false, true}) {
        data.projection = Perspective{};
        if (orthographic) data.projection = Orthographic{};
        const Camera camera(data, 90, 70);
        for (const auto& [x, y] : {std::pair{45.f, 35.f}, {0.f, 0.f}, {89.f, 12.f}}) {
            const Ray ray = camera.ray(x, y);
            const Vec3 seen = camera.project(ray.origin + ray.direction * 3.5f);
            EXPECT_GT(seen.z, 0);
            EXPECT_NEAR(seen.x / seen.z, x, 1e-3);
            EXPECT_NEAR(seen.y / seen.z, y, 1e-3);
        }
        const Ray ray = camera.ray(10, 20);
        if (!orthographic) {
            EXPECT_LT(camera.project(ray.origin - ray.direction).z, 0) << "behind the eye";
        }
    }
}

TEST(Camera, TakesAScreenThatIsGiven) {
    CameraData data = test::camera({0, 0, 0}, {0, 0, -1}, 90);
    data.screen = {0, 1, -1, 0};
    data.screen_given = true;
    const Camera camera(data, 64, 64);
    EXPECT_NEAR(length(camera.ray(0, 0).direction - Vec3{0, 0, -1}), 0, 1e-6f);
    EXPECT_NEAR(length(camera.ray(64, 64).direction - normalize({1, -1, -1})), 0, 1e-6f);
}

TEST(Camera, SeesNothingBeforeItsNearestPlane) {
    CameraData data;
    data.to_world.m[2][3] = 5;
    data.nearest = 2;
    for (const bool parallel : {false, true})
        for (const float lens : {0.0f, 0.5f}) {
            if (parallel) data.projection = Orthographic{};
            data.lens_radius = lens, data.focus_distance = 9;
            const Camera camera(data, 8, 4);
            data.nearest = 0;
            const Camera whole(data, 8, 4);
            data.nearest = 2;
            const auto [ray, from_eye] = lens > 0
                                             ? std::pair{camera.ray(1, 3, {0.9f, 0.2f}), whole.ray(1, 3, {0.9f, 0.2f})}
                                             : std::pair{camera.ray(1, 3), whole.ray(1, 3)};
            EXPECT_NEAR(ray.origin.z, 7, 1e-5f);
            EXPECT_EQ(ray.direction, from_eye.direction);
            EXPECT_LT(length(cross(ray.origin - from_eye.origin, ray.direction)), 1e-5f);
        }
}

TEST(Camera, SeesNothingBeyondItsFarthestPlane) {
    CameraData data = test::camera({1, 2, 9}, {1, 2, 0}, 50);
    data.nearest = 2, data.farthest = 5;
    for (const bool parallel : {false, true}) {
        if (parallel) data.projection = Orthographic{};
        const Ray ray = Camera(data, 8, 4).ray(1, 3);
        EXPECT_NEAR(ray.origin.z, 7, 1e-5f);
        EXPECT_NEAR((ray.origin + ray.direction * ray.far).z, 4, 1e-5f);
    }
}

TEST(Camera, GivesManyRaysAsItGivesOne) {
    for (const float lens_radius : {0.0f, 0.1f}) {
        CameraData data = test::camera({1, 2, 3}, {0, 1, 0}, 50);
        data.lens_radius = lens_radius;
        data.focus_distance = 4;
        const Camera camera(data, 60, 40);
        std::vector<Vec2> positions, lens;
        for (std::uint32_t i = 0; i < 50; ++i) {
            Samples numbers(2, i);
            positions.push_back(numbers.next_2d() * 40);
            if (camera.has_lens()) lens.push_back(numbers.next_2d());
        }
        std::vector<Ray> rays(positions.size());
        camera.rays(positions, lens, rays);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const auto [x, y] = positions[i];
            const Ray one = lens.empty() ? camera.ray(x, y) : camera.ray(x, y, lens[i]);
            EXPECT_EQ(rays[i].origin, one.origin);
            EXPECT_EQ(rays[i].direction, one.direction);
        }
    }
}

TEST(Camera, IsSharpInItsFocusAndNowhereElse) {
    CameraData data = test::camera({1, 2, 3}, {1, 2, 0}, 60);
    data.lens_radius = 0.1f;
    data.focus_distance = 4;
    const Camera camera(data, 100, 80);
    ASSERT_TRUE(camera.has_lens());
    EXPECT_FALSE(Camera(test::camera({1, 2, 3}, {1, 2, 0}, 60), 100, 80).has_lens());
    for (const Vec2 at : {Vec2{50, 40}, Vec2{3, 77}}) {
        const Ray middle = camera.ray(at.x, at.y);
        const Vec3 sharp = middle.origin + middle.direction * (4 / -middle.direction.z);
        double largest = 0, mean = 0;
        for (std::uint32_t i = 0; i < 4096; ++i) {
            const Ray ray = camera.ray(at.x, at.y, Samples(1, i).next_2d());
            EXPECT_EQ(ray.origin.z, 3);
            const auto meets = [&](float distance) {
                return ray.origin + ray.direction * (distance / -ray.direction.z);
            };
            ASSERT_NEAR(length(meets(4) - sharp), 0, 1e-5f);
            // similar triangles: twice as far away the circle of confusion is as large as the lens
            const Vec3 blurred = meets(8) - (middle.origin + middle.direction * (8 / -middle.direction.z));
            largest = std::max(largest, double(length(blurred)));
            mean += length_squared(blurred) / 4096;
        }
        EXPECT_NEAR(largest, 0.1, 1e-3);
        EXPECT_NEAR(mean, 0.1 * 0.1 / 2, 1e-5);  // uniform over the disk
    }
}

TEST(Camera, WithoutPerspectiveHasParallelRays) {
    CameraData data = test::camera({0, 0, 5}, {0, 0, 0}, 60);
    data.projection = Orthographic{};
    data.screen = {-3, 3, -2, 2};
    data.screen_given = true;
    const Camera camera(data, 60, 40);
    const Ray corner = camera.ray(0, 0), other = camera.ray(60, 40);
    EXPECT_NEAR(length(corner.origin - Vec3{-3, 2, 5}), 0, 1e-6f);
    EXPECT_NEAR(length(other.origin - Vec3{3, -2, 5}), 0, 1e-6f);
    EXPECT_NEAR(length(corner.direction - Vec3{0, 0, -1}), 0, 1e-6f);
    EXPECT_EQ(corner.direction, other.direction);

    data.lens_radius = 0.5f;
    data.focus_distance = 5;
    const Ray through = Camera(data, 60, 40).ray(0, 0, {0.9f, 0.2f});
    const Vec3 sharp = through.origin + through.direction * (5 / -through.direction.z);
    EXPECT_NEAR(length(sharp - Vec3{-3, 2, 0}), 0, 1e-5f);
    EXPECT_NEAR(length(through.direction), 1, 1e-6f);
}

// Where a point of the world lies in the picture, by search over the camera's own rays.
bool sees(const Camera& camera, Vec3 point, float width, float height) {
    const Vec3 eye = camera.ray(0, 0).origin;
    const Vec3 left_top = camera.ray(0, 0).direction, right_top = camera.ray(width, 0).direction,
               left_low = camera.ray(0, height).direction, right_low = camera.ray(width, height).direction;
    const Vec3 way = point - eye, inside = camera.ray(width / 2, height / 2).direction;
    for (const auto& [a, b] :
         {std::pair{left_top, right_top}, {right_top, right_low}, {right_low, left_low}, {left_low, left_top}}) {
        const Vec3 side = cross(a, b);
        if (dot(side, way) * dot(side, inside) < 0) return false;
    }
    return true;
}

TEST(Camera, ThatNobodyGaveSeesEverything) {
    for (const auto& [width, height] : {std::pair{200u, 100u}, {100u, 300u}, {64u, 64u}})
        for (const auto& [low, high] : {std::pair{Vec3{-1, -1, -1}, Vec3{1, 1, 1}},
                                        {Vec3{10, 0, 3}, Vec3{40, 2, 3}},
                                        {Vec3{0, 0, 0}, Vec3{0.01f, 1, 0.01f}}}) {
            const Camera camera(camera_for(low, high, width, height), width, height);
            for (int i = 0; i < 8; ++i)
                EXPECT_TRUE(sees(camera, {i & 1 ? low.x : high.x, i & 2 ? low.y : high.y, i & 4 ? low.z : high.z},
                                 float(width), float(height)));
            // and not from too far away: half as far it would miss something
            const Vec3 center = (low + high) * 0.5f, eye = camera.ray(0, 0).origin;
            EXPECT_LT(length(eye - center), 4 * length(high - low));
            EXPECT_GT(eye.y, center.y);
        }
}

TEST(Camera, IsTheOneGivenOrOneThatSeesTheScene) {
    SceneData data;
    test::add(data, test::ball({100, 0, 0}, 2), test::diffuse(data, 0.5f));
    EXPECT_TRUE(Scene(data).intersect(Scene(data).camera().ray(256, 256)));
    data.camera = test::camera({0, 0, 0}, {-1, 0, 0}, 60);
    data.camera_given = true;
    EXPECT_EQ(Scene(data).camera().ray(0, 0).origin, (Vec3{0, 0, 0}));
}

TEST(Camera, IsAllThatDiffersWhereASceneIsLookedAtOtherwise) {
    SceneData data;
    test::add(data, test::ball({100, 0, 0}, 2), test::diffuse(data, 0.5f));
    data.camera = test::camera({0, 0, 0}, {1, 0, 0}, 60);
    data.camera_given = true;
    const SceneOptions options{.width = 64, .height = 32};
    const Scene whole(data, options);
    const Onlooker by{test::camera({100, 0, 9}, {100, 0, 0}, 30), true, FilmData{8, 8, 2}};
    const Scene other(whole, by, options);
    data.camera = by.camera, data.film = by.film;
    const Scene anew(data, options);
    const Ray ray = other.camera().ray(20, 11), same = anew.camera().ray(20, 11);
    EXPECT_EQ(ray.origin, same.origin);
    EXPECT_EQ(ray.direction, same.direction);
    EXPECT_EQ(other.seen_from().to_world, by.camera.to_world);
    EXPECT_EQ(other.film().width, 64) << "of the picture that is asked for";
    EXPECT_EQ(other.film().scale, 2);
    EXPECT_EQ(whole.seen_from().to_world.m[0][3], 0);
    EXPECT_EQ(&other.data(), &whole.data()) << "nothing is there twice";
    EXPECT_TRUE(other.intersect(other.camera().ray(32, 16)));
}

}  // namespace
}  // namespace lightnet::camera_test
