// Motion in pbrt's files: ActiveTransform, TransformTimes and the camera's shutter.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/readers/read_scene.hpp"
#include "tests/support/memory_files.hpp"
#include "tests/support/mistake.hpp"
#include "tests/support/scene_text.hpp"

namespace lightnet::test::pbrt_motion_reader_test {
namespace {

using testing::HasSubstr;

const std::string triangle = " Shape \"trianglemesh\" \"point3 P\" [0 0 0  1 0 0  0 1 0] \"integer indices\" [0 1 2] ";
const std::string sideways = " ActiveTransform EndTime Translate 8 0 0 ActiveTransform All ";

SceneData read_moving(const std::string& text, const SceneConstants& constants = {}) {
    MemoryFiles files{{"a.pbrt", text}};
    return read_scene(files, "a.pbrt", constants);
}
SceneConstants moment(const std::string& seconds) { return {{std::string(time_constant), seconds}}; }

std::string seen(const std::string& camera, const std::string& world) {
    return camera + " Camera \"perspective\" WorldBegin " + world;
}

Vec3 second_vertex(const SceneData& scene) { return std::get<Mesh>(scene.shapes.at(0).geometry).positions.at(1); }
Vec3 last_place(const SceneData& scene) {
    return std::get<Mesh>(scene.motion.shapes.at(0).later.back()).positions.at(1);
}

TEST(PbrtMotion, IsBlurredInTheShutterThatAFileHasUnsaid) {
    const auto scene = read_moving(seen("", sideways + triangle));
    EXPECT_EQ(second_vertex(scene), (Vec3{1, 0, 0}));
    EXPECT_EQ(last_place(scene), (Vec3{9, 0, 0}));
    EXPECT_EQ(scene.motion.shapes.at(0).later.size(), 1u) << "its way is straight";
    EXPECT_EQ(scene.warnings.size(), 0u) << warnings_of(scene);
    EXPECT_EQ(scene.animations.at(0).seconds, 1);
}

TEST(PbrtMotion, IsThatOfTheCamerasShutter) {
    const auto scene = read_moving(
        "Camera \"perspective\" \"float shutteropen\" .25 \"float shutterclose\" .5 WorldBegin" + sideways + triangle);
    EXPECT_EQ(second_vertex(scene), (Vec3{3, 0, 0}));
    EXPECT_EQ(last_place(scene), (Vec3{5, 0, 0}));
}

TEST(PbrtMotion, LastsAsLongAsTransformTimesSay) {
    const auto slow = read_moving(seen("TransformTimes 0 2", sideways + triangle));
    EXPECT_EQ(last_place(slow), (Vec3{5, 0, 0}));
    const auto early = read_moving(seen("TransformTimes -1 .5", sideways + triangle));
    EXPECT_EQ(last_place(early), (Vec3{9, 0, 0})) << "it stands still behind its end";
}

TEST(PbrtMotion, StandsAsAtTheMomentThatIsWanted) {
    const auto scene = read_moving(seen("", sideways + triangle), moment("0.25"));
    EXPECT_EQ(second_vertex(scene), (Vec3{3, 0, 0}));
    EXPECT_TRUE(scene.motion.empty());
}

TEST(PbrtMotion, TurnsByTheShorterWay) {
    const auto scene =
        read_moving(seen("", "ActiveTransform EndTime Rotate 90 0 0 1 ActiveTransform All" + triangle), moment("0.5"));
    EXPECT_NEAR(second_vertex(scene).x, std::sqrt(0.5f), 1e-6);
    EXPECT_NEAR(second_vertex(scene).y, std::sqrt(0.5f), 1e-6);
}

TEST(PbrtMotion, IsTheCamerasAsWell) {
    const auto scene = read_moving(seen("ActiveTransform EndTime Translate 0 0 4 ActiveTransform All", triangle));
    EXPECT_EQ(scene.camera.to_world.m[2][3], 0);
    EXPECT_EQ(scene.camera.later.back().to_world.m[2][3], -4);
    EXPECT_TRUE(scene.motion.empty()) << "the world begins anew";
}

TEST(PbrtMotion, IsThatOfInstances) {
    const auto scene =
        read_moving(seen("", "ObjectBegin \"o\"" + triangle + "ObjectEnd" + sideways + "ObjectInstance \"o\""));
    EXPECT_EQ(scene.motion.instances.at(0).later.back().m[0][3], 8);
}

TEST(PbrtMotion, IsKeptByNamesAndBlocks) {
    const auto named =
        read_moving(seen("", "AttributeBegin" + sideways +
                                 "CoordinateSystem \"sled\" AttributeEnd CoordSysTransform \"sled\"" + triangle));
    EXPECT_EQ(last_place(named), (Vec3{9, 0, 0}));
    const auto still = read_moving(seen("", "AttributeBegin" + sideways + "AttributeEnd" + triangle));
    EXPECT_TRUE(still.motion.empty());
    EXPECT_TRUE(still.animations.empty());
}

TEST(PbrtMotion, IsTheOlderFilesAsWell) {
    const auto scene = read_moving(seen("", sideways + triangle + "WorldEnd"), {{"pbrt", "3"}});
    EXPECT_EQ(last_place(scene), (Vec3{9, 0, 0}));
}

TEST(PbrtMotion, GivesWayToAnotherShutter) {
    const auto scene = read_moving(seen("", sideways + triangle), {{std::string(shutter_constant), "0.5 0.75"}});
    EXPECT_EQ(second_vertex(scene), (Vec3{5, 0, 0}));
    EXPECT_EQ(last_place(scene), (Vec3{7, 0, 0}));
}

TEST(PbrtMotion, SaysWhatIsWrong) {
    EXPECT_THAT(mistake_of([] { read_moving(seen("TransformTimes 1 1", triangle)); }),
                HasSubstr("a.pbrt:1: TransformTimes: the end must come after the start"));
    EXPECT_THAT(mistake_of([] {
                    read_moving(seen("", triangle), {{std::string(animation_constant), "walk"}});
                }),
                HasSubstr("pbrt's motion has no names"));
}

}  // namespace
}  // namespace lightnet::test::pbrt_motion_reader_test
