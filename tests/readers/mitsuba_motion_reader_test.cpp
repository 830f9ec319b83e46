// Mitsuba's <animation>: shapes and sensors at a moment.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/readers/read_scene.hpp"
#include "tests/support/memory_files.hpp"
#include "tests/support/mistake.hpp"
#include "tests/support/scene_text.hpp"

namespace lightnet::test::mitsuba_motion_reader_test {
namespace {

using testing::HasSubstr;

const std::string moving = R"(<scene version="0.6.0">
    <sensor type="perspective"><animation name="toWorld">
        <transform time="0"><translate z="-5"/></transform>
        <transform time="2"><translate z="-9"/></transform></animation></sensor>
    <shape type="sphere"><animation name="toWorld">
        <transform time="0"><translate x="0"/></transform>
        <transform time="1"><translate x="4"/></transform></animation></shape>
    <shape type="sphere"/></scene>)";

SceneData at(const std::string& text, const SceneConstants& constants) {
    MemoryFiles files{{"a.xml", text}};
    return read_scene(files, "a.xml", constants);
}

float eye(const SceneData& scene) { return float(scene.camera.to_world.m[2][3]); }
float ball(const SceneData& scene) { return std::get<Sphere>(scene.shapes.at(0).geometry).center.x; }

TEST(MitsubaMotion, StandsAsAtTheMomentThatIsWanted) {
    const auto scene = at(moving, {{std::string(time_constant), "0.5"}});
    EXPECT_FLOAT_EQ(eye(scene), -6);
    EXPECT_FLOAT_EQ(ball(scene), 2);
    EXPECT_EQ(scene.animations.at(0).seconds, 2);
    EXPECT_EQ(warnings_of(scene).find("animated"), std::string::npos);
    EXPECT_FLOAT_EQ(ball(at(moving, {{std::string(time_constant), "7"}})), 4);
}

TEST(MitsubaMotion, StandsAsAtFirstInAStill) {
    const auto scene = at(moving, {});
    EXPECT_FLOAT_EQ(eye(scene), -5);
    EXPECT_FLOAT_EQ(ball(scene), 0);
    EXPECT_THAT(warnings_of(scene), HasSubstr("animated transforms are taken as they stand at first"));
}

TEST(MitsubaMotion, IsThatOfTheSensorsShutter) {
    auto open = moving;
    open.insert(open.find("<animation"),
                "<float name=\"shutterOpen\" value=\".25\"/><float name=\"shutterClose\" value=\".75\"/>");
    const auto scene = at(open, {});
    EXPECT_FLOAT_EQ(ball(scene), 1);
    EXPECT_FLOAT_EQ(std::get<Sphere>(scene.motion.shapes.at(0).later.back()).center.x, 3);
    EXPECT_FLOAT_EQ(float(scene.camera.later.back().to_world.m[2][3]), -6.5f);
    EXPECT_EQ(warnings_of(scene).find("animated"), std::string::npos);
    // another moment is an instant, and another shutter takes its place
    EXPECT_TRUE(at(open, {{std::string(time_constant), "0.5"}}).motion.empty());
    EXPECT_TRUE(at(open, {{std::string(shutter_constant), "0 0"}}).motion.empty());
    EXPECT_FLOAT_EQ(ball(at(open, {{std::string(shutter_constant), "0 0"}})), 0);
}

TEST(MitsubaMotion, SaysWhatIsWrong) {
    auto backwards_shutter = moving;
    backwards_shutter.insert(backwards_shutter.find("<animation"), "<float name=\"shutterOpen\" value=\"1\"/>");
    EXPECT_THAT(mistake_of([&] { at(backwards_shutter, {}); }), HasSubstr("must not close before it opens"));

    auto backwards = moving;
    backwards.replace(backwards.find("time=\"2\""), 8, "time=\"0\"");
    EXPECT_THAT(mistake_of([&] { at(backwards, {}); }), HasSubstr("the times of an animation follow each other"));
    EXPECT_THAT(mistake_of([&] {
                    at(moving, {{std::string(animation_constant), "walk"}});
                }),
                HasSubstr("Mitsuba's animations have no names"));
}

TEST(SceneFormats, WithoutMotionStandStillAtAnyTime) {
    const std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    MemoryFiles files{{"a.obj", text}};
    EXPECT_EQ(read_scene(files, "a.obj", {{std::string(time_constant), "3"}}).shapes.size(), 1);
    EXPECT_THAT(mistake_of([&] {
                    read_scene(files, "a.obj", {{std::string(animation_constant), "walk"}});
                }),
                HasSubstr("nothing in such a file is animated"));
}

}  // namespace
}  // namespace lightnet::test::mitsuba_motion_reader_test
