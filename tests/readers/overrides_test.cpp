// What a graph changes about a scene.
#include "core/readers/overrides.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/memory_files.hpp"

namespace lightnet::overrides_test {
namespace {

using testing::HasSubstr;

void expect_near(Vec3 a, Vec3 b) { EXPECT_LT(length(a - b), 1e-5f) << a.x << ' ' << a.y << ' ' << a.z; }

/// A scene whose camera is that of a right-handed world, at (0, 0, 5), looking along -z.
SceneData with_camera() {
    SceneData scene;
    scene.camera_given = true;
    scene.camera.to_world.m = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, -1, 5}, {0, 0, 0, 1}}};
    return scene;
}

SceneData changed(SceneData scene, const SceneOverrides& overrides, test::MemoryFiles files = {}) {
    apply(overrides, scene, files, {"g.lua", 3});
    return scene;
}

std::string error_of(SceneData scene, const SceneOverrides& overrides, test::MemoryFiles files = {}) {
    try {
        apply(overrides, scene, files, {"g.lua", 3});
    } catch (const UserError& error) {
        return error.what();
    }
    return "";
}

SceneOverrides camera(const CameraOverride& change) {
    SceneOverrides overrides;
    overrides.camera = change;
    return overrides;
}

TEST(SceneOverrides, MoveTheCamera) {
    CameraOverride change;
    change.from = Vec3{5, 0, 0};
    change.to = Vec3{};
    const auto scene = changed(with_camera(), camera(change));
    const Matrix& m = scene.camera.to_world;
    expect_near(transform_point(m, {0, 0, 5}), {0, 0, 0});
    expect_near(transform_direction(m, {0, 1, 0}), {0, 1, 0});
    expect_near(transform_direction(m, {1, 0, 0}), {0, 0, -1});  // still no mirror
}

TEST(SceneOverrides, MoveTheCameraWhileTheShutterIsOpen) {
    CameraOverride first, step, later;
    first.from = Vec3{5, 0, 0}, first.to = Vec3{};
    step = later = first;
    step.from = Vec3{5, 1, 0}, later.from = Vec3{5, 2, 0}, later.fov = 20;
    auto wanted = camera(first);
    wanted.camera_later = {step, later};
    wanted.next_camera = later;
    const auto eye = [](const CameraData& camera) { return transform_point(camera.to_world, {0, 0, 0}); };
    const auto scene = changed(with_camera(), wanted);
    ASSERT_EQ(scene.camera.later.size(), 2U);
    expect_near(eye(scene.camera), {5, 0, 0});
    expect_near(eye(scene.camera.later[0]), {5, 1, 0});
    expect_near(eye(scene.camera.later[1]), {5, 2, 0});
    EXPECT_EQ(scene.camera.later[1].fov, 20);
    ASSERT_EQ(scene.camera.next.size(), 1U);
    expect_near(eye(scene.camera.next[0]), {5, 2, 0});
    const auto again = look_again(wanted, changed(with_camera(), {}), {"g.lua", 3});
    ASSERT_TRUE(again);
    EXPECT_EQ(again->camera.later.size(), 2U) << "as when the scene is read for it";
    EXPECT_EQ(again->camera.next.size(), 1U);
}

TEST(SceneOverrides, LetAnotherLookAtAChangedSceneAsIfItHadBeenReadForThat) {
    CameraOverride first, second;
    first.from = Vec3{5, 0, 0}, first.to = Vec3{}, first.fov = 20;
    second.from = Vec3{0, 7, 1};
    const auto scene = changed(with_camera(), camera(first));
    auto wanted = camera(second);
    wanted.exposure = 1;
    const auto onlooker = look_again(wanted, scene, {"g.lua", 3});
    const auto anew = changed(with_camera(), wanted);
    ASSERT_TRUE(onlooker);
    EXPECT_EQ(onlooker->camera.to_world, anew.camera.to_world) << "from the file's camera, not from the first one's";
    EXPECT_EQ(onlooker->camera.fov, anew.camera.fov);
    EXPECT_EQ(onlooker->film.scale, anew.film.scale);
}

TEST(SceneOverrides, ReadASceneAnewWhereMoreHangsOnTheCamera) {
    CameraOverride change;
    change.from = Vec3{5, 0, 0}, change.to = Vec3{};
    const auto scene = changed(SceneData{}, camera(change));
    EXPECT_FALSE(look_again({}, scene, {})) << "nobody knows who looks then";
    change.up = Vec3{0, 0, 1};
    auto lying = camera(change);
    lying.sky.emplace();
    EXPECT_FALSE(look_again(lying, scene, {})) << "another axis is up for it, and so for the sky";
}

TEST(SceneOverrides, KeepWhatTheyDoNotName) {
    CameraOverride change;
    change.to = Vec3{1, 0, 4};
    const auto scene = changed(with_camera(), camera(change));
    expect_near(transform_point(scene.camera.to_world, {}), {0, 0, 5});
    expect_near(transform_direction(scene.camera.to_world, {0, 0, 1}), normalize(Vec3{1, 0, -1}));
    EXPECT_EQ(scene.camera.fov, 90);
    change = {};
    change.fov = 30, change.lens = 0.2f, change.focus = 7;
    const auto lens = changed(with_camera(), camera(change)).camera;
    EXPECT_EQ(lens.to_world, with_camera().camera.to_world);
    EXPECT_EQ(lens.fov, 30);
    EXPECT_EQ(lens.lens_radius, 0.2f);
    EXPECT_EQ(lens.focus_distance, 7);
}

SceneData with_two_cameras() {
    SceneData scene = with_camera();
    SceneCamera first{"balcony", scene.camera, {}}, second{"", scene.camera, {}};
    second.camera.fov = 20;
    second.film.width = 77;
    scene.cameras = {first, second};
    return scene;
}

TEST(SceneOverrides, ChooseOneOfTheCamerasOfTheFile) {
    const auto seen_by = [](const std::string& camera) {
        SceneOverrides overrides;
        overrides.seen_by = camera;
        return overrides;
    };
    EXPECT_EQ(changed(with_two_cameras(), seen_by("2")).camera.fov, 20);
    EXPECT_EQ(changed(with_two_cameras(), seen_by("2")).film.width, 77u);
    EXPECT_EQ(changed(with_two_cameras(), seen_by("balcony")).camera.fov, 90);
    EXPECT_EQ(changed(with_two_cameras(), seen_by("1")).camera.fov, 90);
    EXPECT_THAT(error_of(with_two_cameras(), seen_by("balcny")), HasSubstr("did you mean 'balcony'?"));
    EXPECT_THAT(error_of(with_two_cameras(), seen_by("3")), HasSubstr("there is no camera '3'"));
    EXPECT_THAT(error_of(with_camera(), seen_by("1")), HasSubstr("the scene's file has none to choose from"));
    auto moved = seen_by("2");
    moved.camera = CameraOverride{};
    moved.camera->fov = 50;
    EXPECT_EQ(changed(with_two_cameras(), moved).camera.fov, 50) << "what the graph says of it comes after";
}

TEST(SceneOverrides, OfACameraMustSpanAView) {
    CameraOverride change;
    change.from = Vec3{0, 5, 0};
    change.to = Vec3{};
    EXPECT_THAT(error_of(with_camera(), camera(change)),
                HasSubstr("g.lua:3: 'camera': 'from', 'to' and 'up' must span"));
    change.to.reset();
    EXPECT_THAT(error_of({}, camera(change)), HasSubstr("both 'from' and 'to' must be given"));
}

TEST(SceneOverrides, PutAColourAround) {
    SceneOverrides overrides;
    overrides.environment = Rgb{1, 2, 3};
    overrides.parts.environment_scale = 2;
    SceneData old = with_camera();
    old.environments.resize(2);
    const auto scene = changed(old, overrides);
    ASSERT_EQ(scene.environments.size(), 1u);
    EXPECT_EQ(scene.environments[0].radiance, (Rgb{2, 4, 6}));
    overrides.environment = Rgb{};
    EXPECT_TRUE(changed(old, overrides).environments.empty());
}

TEST(SceneOverrides, LeaveNothingSaidOfLightThatSomebodyChose) {
    SceneOverrides overrides;
    SceneData old = with_camera();
    old.warnings = {{{}, "there is no light: a constant environment is taken (choose one with '--env')"},
                    {{}, "a thing is left out"}};
    EXPECT_EQ(changed(old, overrides).warnings.size(), 2u);
    overrides.environment = Rgb{1, 1, 1};
    EXPECT_EQ(changed(old, overrides).warnings, (std::vector<Problem>{{{}, "a thing is left out"}}));
}

TEST(SceneOverrides, PutAPictureAroundWhoseTopIsUp) {
    const test::MemoryFiles files{
        {"sky.hdr", std::string("#?RADIANCE\n\n-Y 1 +X 2\n") + std::string("\x80\x40\x20\x81\x80\x40\x20\x81", 8)}};
    SceneOverrides overrides;
    overrides.environment = std::string("sky.hdr");
    const auto straight = changed(with_camera(), overrides, files).environments.at(0);
    EXPECT_EQ(straight.to_world, Matrix{});
    EXPECT_EQ(straight.layout, EnvironmentData::Layout::latitude_longitude);
    SceneData flat = with_camera();  // z is up
    flat.camera.to_world.m = {{{1, 0, 0, 0}, {0, 0, 1, 0}, {0, 1, 0, 0}, {0, 0, 0, 1}}};
    const Matrix turn = changed(flat, overrides, files).environments.at(0).to_world;
    expect_near(transform_direction(turn, {0, 1, 0}), {0, 0, 1});
    EXPECT_FALSE(swaps_handedness(turn));
    EXPECT_THAT(error_of(with_camera(), overrides), HasSubstr("g.lua:3: 'environment': can't read 'sky.hdr'"));
}

TEST(SceneOverrides, PutASkyAroundWithItsSun) {
    SceneOverrides overrides;
    overrides.sky = SkyOverride{};
    overrides.sky->towards = Vec3{0, 2, -2};
    overrides.sky->scale = 3;
    overrides.sky->sun_scale = 2;
    overrides.sky->sun_angle = 4.0f;
    SceneData old = with_camera();
    old.environments.resize(2);
    const auto scene = changed(old, overrides);
    ASSERT_EQ(scene.environments.size(), 1u);
    EXPECT_EQ(scene.environments[0].radiance, (Rgb{3, 3, 3}));
    ASSERT_EQ(scene.lights.size(), 1u);
    const auto& sun = std::get<DirectionalLight>(scene.lights[0]);
    expect_near(sun.direction, normalize({0, -1, 1}));
    EXPECT_NEAR(sun.half_angle, 2 * std::numbers::pi_v<float> / 180, 1e-6f);
    overrides.sky->scale = 1;
    overrides.sky->sun_scale = 1;
    const auto plain = std::get<DirectionalLight>(changed(old, overrides).lights.at(0));
    EXPECT_NEAR(sun.irradiance.g / plain.irradiance.g, 6, 1e-4f);
    overrides.sky->sun_scale = 0;
    EXPECT_TRUE(changed(old, overrides).lights.empty());
}

TEST(SceneOverrides, KeepTheSkyUpWhereTheFormatSaysWhatIsUp) {
    SceneOverrides overrides;
    overrides.sky = SkyOverride{};
    SceneData from_above = with_camera();  // which looks straight down: up in its picture is -z
    from_above.camera.to_world.m = {{{1, 0, 0, 0}, {0, 0, -1, 5}, {0, -1, 0, 0}, {0, 0, 0, 1}}};
    EXPECT_GT(std::get<DirectionalLight>(changed(from_above, overrides).lights.at(0)).direction.z, 0);
    from_above.up = Vec3{0, 1, 0};
    const auto scene = changed(from_above, overrides);
    EXPECT_NEAR(std::get<DirectionalLight>(scene.lights.at(0)).direction.y, -std::sqrt(0.5f), 1e-6f);
    auto elsewhere = overrides;
    elsewhere.camera.emplace().up = Vec3{1, 0, 0};
    EXPECT_TRUE(look_again(elsewhere, scene, {})) << "no camera changes that";
}

TEST(SceneOverrides, PutTheSunAboveTheHorizon) {
    SceneOverrides overrides;
    overrides.sky = SkyOverride{};
    SceneData flat = with_camera();  // z is up
    flat.camera.to_world.m = {{{1, 0, 0, 0}, {0, 0, 1, 0}, {0, 1, 0, 0}, {0, 0, 0, 1}}};
    const auto sun = std::get<DirectionalLight>(changed(flat, overrides).lights.at(0));
    EXPECT_NEAR(sun.direction.z, -std::sqrt(0.5f), 1e-6f) << "half-way up";
    overrides.sky->towards = Vec3{0, 1, -1};
    EXPECT_THAT(error_of(flat, overrides),
                HasSubstr("g.lua:3: 'sky': the sun is 45.0° below the horizon (up is { 0, 0, 1 })"));
    overrides.sky->towards = Vec3{};
    EXPECT_THAT(error_of(flat, overrides), HasSubstr("'towards' must be a direction"));
    overrides.sky->towards = Vec3{0, 0, 1};
    overrides.environment = Rgb{1, 1, 1};
    EXPECT_THAT(error_of(flat, overrides), HasSubstr("'sky' and 'environment': only one of them"));
}

TEST(SceneOverrides, ExposeInStops) {
    SceneOverrides overrides;
    overrides.exposure = -2;
    SceneData scene = with_camera();
    scene.film.scale = 8;
    EXPECT_EQ(changed(scene, overrides).film.scale, 2);
}

TEST(SceneOverrides, OfClayKeepWhatIsCutOutAndWhatIsNotThere) {
    SceneData scene = with_camera();
    scene.textures.resize(1);
    scene.materials.resize(2);
    scene.materials[0].model = ConductorMaterial{};
    scene.materials[0].opacity = 0;
    scene.materials[0].bump_map = 0;
    scene.materials[1].model = NoMaterial{};
    SceneOverrides overrides;
    overrides.clay = true;
    const auto clay = changed(scene, overrides);
    const auto& model = std::get<DiffuseMaterial>(clay.materials[0].model);
    EXPECT_EQ(clay.textures.at(model.reflectance).scale, (Rgb{0.5f, 0.5f, 0.5f}));
    EXPECT_EQ(clay.materials[0].opacity, 0u);
    EXPECT_FALSE(clay.materials[0].bump_map);
    EXPECT_TRUE(std::holds_alternative<NoMaterial>(clay.materials[1].model));
}

TEST(SceneOverrides, TakeBlackBacksAway) {
    SceneData scene = with_camera();
    scene.materials.resize(2);
    scene.materials[1].one_sided = true;
    SceneOverrides overrides;
    EXPECT_TRUE(changed(scene, overrides).materials[1].one_sided);
    overrides.two_sided = true;
    EXPECT_FALSE(changed(scene, overrides).materials[1].one_sided);
}

// Fog is everywhere but in solid glass and in what the file fills.
TEST(SceneOverrides, FillSpaceWithFog) {
    SceneData scene = with_camera();
    scene.materials.push_back({"glass", DielectricMaterial{}});
    scene.materials.push_back({"nothing", NoMaterial{}});
    scene.media.emplace_back();
    scene.shapes.push_back({Sphere{}, 0, {}, {}});
    scene.shapes.push_back({Sphere{}, 1, {}, {}, "", MediumSides{0, Query::no_medium}});
    SceneOverrides overrides;
    overrides.fog = FogOverride{0.5f, {1, 0.5f, 0}, 0.25f};
    const auto foggy = changed(scene, overrides);
    ASSERT_EQ(foggy.media.size(), 2u);
    EXPECT_EQ(foggy.media[1].extinction.value, (Rgb{0.5f, 0.5f, 0.5f}));
    EXPECT_EQ(foggy.media[1].albedo_at({}), (Rgb{1, 0.5f, 0}));
    EXPECT_EQ(foggy.media[1].phase.g, 0.25f);
    EXPECT_EQ(foggy.around, 1);
    EXPECT_EQ(foggy.shapes[0].media->inside, Query::no_medium);
    EXPECT_EQ(foggy.shapes[0].media->outside, 1);
    EXPECT_EQ(foggy.shapes[1].media->inside, 0);
    EXPECT_EQ(foggy.shapes[1].media->outside, 1);
    overrides.fog->albedo.r = 2;
    EXPECT_THAT(error_of(scene, overrides), HasSubstr("g.lua:3: 'fog': an 'albedo' can't be above 1"));
}

}  // namespace
}  // namespace lightnet::overrides_test
