// glTF in motion: animations of nodes, morph targets, skins, cameras and lights, at a moment.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "core/readers/read_scene.hpp"
#include "tests/support/gltf_text.hpp"
#include "tests/support/memory_files.hpp"
#include "tests/support/mistake.hpp"

namespace lightnet::test::gltf_motion_reader_test {
namespace {

using testing::HasSubstr;
using testing::SizeIs;

const std::string one_mesh = R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)";

/// A triangle whose node moves by accessors 1 (times) and 2 (values).
struct Moving {
    GltfText text = triangle_text();
    std::string path = "translation", between = "LINEAR";

    void keys(const std::vector<float>& times, const std::string& type, const std::vector<float>& values) {
        text.vectors("SCALAR", times);
        text.vectors(type, values);
    }
    std::string document(const std::string& nodes = R"({"mesh":0})", const std::string& meshes = one_mesh,
                         const std::string& more = "") const {
        return meshes + R"("nodes":[)" + nodes + R"(],"animations":[{"name":"go","samplers":[{"input":1,"output":2,)" +
               R"("interpolation":")" + between + R"("}],"channels":[{"sampler":0,"target":{"node":0,"path":")" + path +
               R"("}}]}],)" + more;
    }
};

SceneData at(const GltfText& text, const std::string& document, const std::string& seconds,
             const std::string& animation = "") {
    MemoryFiles files;
    files.add("a.glb", text.file(document));
    SceneConstants constants{{std::string(time_constant), seconds}};
    if (!animation.empty()) constants[std::string(animation_constant)] = animation;
    return read_scene(files, "a.glb", constants);
}

void expect_near(Vec3 a, Vec3 b) { EXPECT_LT(length(a - b), 1e-5f) << a.x << ' ' << a.y << ' ' << a.z; }
Vec3 corner(const SceneData& scene, std::size_t i = 1) { return mesh_of(scene).positions.at(i); }

TEST(GltfMotion, GoesStraightFromKeyToKeyAndStandsBeyondThem) {
    Moving moving;
    moving.keys({1, 3}, "VEC3", {0, 0, 0, 4, 0, 8});
    const auto document = moving.document();
    expect_near(corner(at(moving.text, document, "0")), {1, 0, 0});
    expect_near(corner(at(moving.text, document, "1.5")), {2, 0, 2});
    expect_near(corner(at(moving.text, document, "9")), {5, 0, 8});
    moving.between = "STEP";
    expect_near(corner(at(moving.text, moving.document(), "2.9")), {1, 0, 0});
    expect_near(corner(at(moving.text, moving.document(), "3")), {5, 0, 8});
}

TEST(GltfMotion, StandsStillUntilATimeIsAskedFor) {
    Moving moving;
    moving.keys({0, 1}, "VEC3", {9, 9, 9, 9, 9, 9});
    const auto still = moving.text.read(moving.document());
    expect_near(corner(still), {1, 0, 0});
    EXPECT_THAT(warnings_of(still), HasSubstr("its animations stand still"));
    ASSERT_THAT(still.animations, SizeIs(1));
    EXPECT_EQ(still.animations[0].name, "go");
    EXPECT_EQ(still.animations[0].seconds, 1);
    EXPECT_EQ(warnings_of(at(moving.text, moving.document(), "0")).find("animation"), std::string::npos);
}

TEST(GltfMotion, IsAsLongAsItsAccessorSaysOfWhichNothingElseIsRead) {
    Moving moving;
    moving.text.accessor<float>("SCALAR", 5126, {0, 1}, 2, R"(,"max":[2.5])");
    moving.text.vectors("VEC3", {9, 9, 9, 9, 9, 9});
    const auto still = moving.text.read(moving.document());
    EXPECT_EQ(still.animations.at(0).seconds, 2.5);
    EXPECT_EQ(warnings_of(still).find("left out"), std::string::npos) << warnings_of(still);
}

TEST(GltfMotion, TurnsEvenlyOnTheShortWay) {
    Moving moving;
    moving.path = "rotation";
    const float half = std::sqrt(0.5f);
    moving.keys({0, 1}, "VEC4", {0, 0, 0, 1, 0, 0, -half, -half});  // a quarter about z, by the other sign
    for (const double t : {0.25, 0.5, 0.8}) {
        const double angle = t * std::numbers::pi / 2;
        expect_near(corner(at(moving.text, moving.document(), std::to_string(t))),
                    {float(std::cos(angle)), float(std::sin(angle)), 0});
    }
}

TEST(GltfMotion, FollowsCubicSplines) {
    Moving moving;
    moving.between = "CUBICSPLINE";
    // x(t) = t³ on 0 … 2: values 0 and 8, slopes 0 and 12; so is the spline, everywhere
    moving.keys({0, 2}, "VEC3", {0, 0, 0, 0, 0, 0, 0, 0, 0, 12, 0, 0, 8, 0, 0, 0, 0, 0});
    for (const double t : {0.5, 1.0, 1.75})
        expect_near(corner(at(moving.text, moving.document(), std::to_string(t)), 0), {float(t * t * t), 0, 0});
}

TEST(GltfMotion, MorphsByWeights) {
    Moving moving;
    moving.path = "weights";
    moving.keys({0, 1}, "SCALAR", {0, 0, 1, 0.5f});
    moving.text.vectors("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});  // 3
    moving.text.vectors("VEC3", {0, 4, 0, 0, 4, 0, 0, 4, 0});  // 4
    const auto document = moving.document(
        R"({"mesh":0})",
        R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"targets":[{"POSITION":3},{"POSITION":4}]}]}],)");
    expect_near(corner(at(moving.text, document, "0.5")), {1, 1, 0.5f});
}

TEST(GltfMotion, MovesWhatHangsOnJointsAndWhatStandsBelowThem) {
    Moving moving;
    moving.keys({0, 2}, "VEC3", {0, 0, 0, 0, 0, 6});
    moving.text.accessor<std::uint8_t>("VEC4", 5121, {0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, 3);  // 3: joints
    moving.text.vectors("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0});                    // 4: weights
    const auto document =
        moving.document(R"({"children":[2]},{"mesh":0,"skin":0},{"translation":[0,10,0]},{})",
                        R"("meshes":[{"primitives":[{"attributes":{"POSITION":0,"JOINTS_0":3,"WEIGHTS_0":4}}]}],)",
                        R"("skins":[{"joints":[3,2]}],)");
    const auto scene = at(moving.text, document, "1");
    expect_near(corner(scene, 0), {0, 0, 0});
    expect_near(corner(scene, 1), {1, 10, 3});
    expect_near(corner(scene, 2), {0, 6, 1.5f});
}

TEST(GltfMotion, MovesCamerasAndLightsAndWhatPointersName) {
    Moving moving;
    moving.keys({0, 1}, "VEC3", {0, 0, 0, 2, 0, 0});
    moving.text.vectors("SCALAR", {1, 3});  // 3
    const std::string nodes = R"({"mesh":0,"camera":0,"extensions":{"KHR_lights_punctual":{"light":0}}})";
    const std::string more =
        R"("cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":0.1}}],
        "extensionsUsed":["KHR_lights_punctual","KHR_animation_pointer"],
        "extensions":{"KHR_lights_punctual":{"lights":[{"type":"point","intensity":1}]}},)";
    auto document = moving.document(nodes, one_mesh, more);
    const std::string first = R"("samplers":[)", second = R"("channels":[)";
    document.insert(document.find(first) + first.size(), R"({"input":1,"output":3},)");
    document.replace(document.find(R"("sampler":0)"), 11, R"("sampler":1)");
    document.insert(document.find(second) + second.size(),
                    R"({"sampler":0,"target":{"path":"pointer","extensions":{"KHR_animation_pointer":
                    {"pointer":"/extensions/KHR_lights_punctual/lights/0/intensity"}}}},)");
    const auto scene = at(moving.text, document, "0.5");
    EXPECT_EQ(scene.camera.to_world.m[0][3], 1);
    const auto& lamp = std::get<PointLight>(scene.lights.at(0));
    expect_near(lamp.position, {1, 0, 0});
    EXPECT_EQ(lamp.intensity, (Rgb{2, 2, 2}));
    EXPECT_EQ(warnings_of(scene).find("left out"), std::string::npos) << warnings_of(scene);
}

TEST(GltfMotion, IsOfTheAnimationThatIsNamed) {
    Moving moving;
    moving.keys({0, 1}, "VEC3", {0, 0, 0, 2, 0, 0});
    const auto document = moving.document();
    expect_near(corner(at(moving.text, document, "1", "go")), {3, 0, 0});
    EXPECT_THAT(mistake_of([&] { at(moving.text, document, "1", "goo"); }),
                HasSubstr("there is no animation 'goo' (did you mean 'go'?)"));
}

TEST(GltfMotion, LeavesWhatPointersNameInVain) {
    for (const char* pointer : {"/nodes/abc/translation", "/nodes/9/translation", "/nodes/99999999999999999999/scale",
                                "/materials/0/x", "/buffers/0/byteLength", "nodes", "", "/nodes//translation"}) {
        Moving moving;
        moving.keys({0, 1}, "VEC3", {0, 0, 0, 2, 0, 0});
        auto document = moving.document();
        const std::string target = R"("node":0,"path":"translation")";
        document.replace(
            document.find(target), target.size(),
            R"("path":"pointer","extensions":{"KHR_animation_pointer":{"pointer":")" + std::string(pointer) + R"("}})");
        const auto scene = at(moving.text, document, "0.5");
        expect_near(corner(scene), {1, 0, 0});
        EXPECT_THAT(warnings_of(scene), HasSubstr("animated")) << pointer;
    }
}

TEST(GltfMotion, SaysWhatIsWrongWithItsKeys) {
    Moving endless;
    endless.keys({0, 1}, "VEC3", {0, 0, 0, std::numeric_limits<float>::infinity(), 0, 0});
    EXPECT_THAT(mistake_of([&] { at(endless.text, endless.document(), "0.5"); }), HasSubstr("not finite"));
    Moving backwards;
    backwards.keys({1, 0}, "VEC3", {0, 0, 0, 2, 0, 0});
    EXPECT_THAT(mistake_of([&] { at(backwards.text, backwards.document(), "0"); }),
                HasSubstr("don't follow each other"));
    Moving few;
    few.keys({0, 1}, "VEC3", {0, 0, 0});
    EXPECT_THAT(mistake_of([&] { at(few.text, few.document(), "0"); }), HasSubstr("must have as many values as keys"));
    Moving odd;
    odd.between = "BEZIER";
    odd.keys({0, 1}, "VEC3", {0, 0, 0, 2, 0, 0});
    EXPECT_THAT(mistake_of([&] { at(odd.text, odd.document(), "0"); }),
                HasSubstr("must be LINEAR, STEP or CUBICSPLINE"));
}

}  // namespace
}  // namespace lightnet::test::gltf_motion_reader_test
