// Sequences of files: what moves between them, for a shutter and for who asks how far things move.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/readers/read_scene.hpp"
#include "tests/support/scene_text.hpp"

namespace lightnet::test::files_of_frames_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// A triangle from (x, 0, 0).
std::string triangle(const std::string& x, const std::string& more = "") {
    return "v " + x + " 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n" + more;
}

MemoryFiles frames(const std::string& first, const std::string& second, const std::string& third) {
    MemoryFiles files;
    files.add("m.1.obj", first);
    files.add("m.2.obj", second);
    files.add("m.3.obj", third);
    return files;
}

SceneConstants shutter(const std::string& span) { return {{std::string(shutter_constant), span}}; }

SceneConstants beside(SceneConstants constants, std::string_view which, const FrameBeside& frame) {
    constants[std::string(which)] = to_constant(frame);
    return constants;
}

float corner(const ShapeGeometry& shape) { return std::get<Mesh>(shape).positions.at(0).x; }

// But for that there is no light.
std::vector<std::string> warnings(const SceneData& scene) {
    std::vector<std::string> all;
    for (const auto& warning : scene.warnings)
        if (warning.what.find("no light") == std::string::npos) all.push_back(warning.what);
    return all;
}

// Frames of half a second; the shutter's times are seconds.
constexpr double frame_time = 0.5;

TEST(FilesOfFrames, AreBlurredTowardsTheNextWhileTheShutterIsOpen) {
    auto files = frames(triangle("0"), triangle("4"), triangle("6"));
    const auto wanted = beside(shutter("0 0.25"), next_constant, {frame_time, {}, "m.2.obj"});
    const auto scene = read_scene(files, "m.1.obj", wanted);
    EXPECT_EQ(corner(scene.shapes.at(0).geometry), 0);
    ASSERT_EQ(scene.motion.shapes.size(), 1U);
    EXPECT_FLOAT_EQ(corner(scene.motion.shapes[0].later.back()), 2);
    EXPECT_THAT(warnings(scene), ElementsAre());
    EXPECT_FALSE(scene.next) << "nobody asks how far it moves";
}

TEST(FilesOfFrames, AreBlurredAroundTheirOwnTime) {
    auto files = frames(triangle("0"), triangle("4"), triangle("6"));
    const auto wanted = beside(beside(shutter("-0.25 0.25"), previous_constant, {frame_time, {}, "m.1.obj"}),
                               next_constant, {frame_time, {}, "m.3.obj"});
    const auto scene = read_scene(files, "m.2.obj", wanted);
    EXPECT_FLOAT_EQ(corner(scene.shapes.at(0).geometry), 2);
    const auto& later = scene.motion.shapes.at(0).later;
    ASSERT_EQ(later.size(), 2U) << "it is quicker at first";
    EXPECT_FLOAT_EQ(corner(later[0]), 4);
    EXPECT_FLOAT_EQ(corner(later[1]), 5);
}

TEST(FilesOfFrames, SwitchWhereTheirPartsAreOthers) {
    auto files = frames(triangle("0"), triangle("4", "f 1 3 2\n"), "");
    const auto wanted = beside(shutter("0 0.25"), next_constant, {frame_time, {}, "m.2.obj"});
    const auto scene = read_scene(files, "m.1.obj", wanted);
    EXPECT_TRUE(scene.motion.empty());
    EXPECT_THAT(warnings(scene), ElementsAre(HasSubstr("other parts in the frame beside it: it stands still")));
}

TEST(FilesOfFrames, StandStillAtTheEndsOfTheSequence) {
    auto files = frames(triangle("0"), triangle("4"), triangle("6"));
    const auto wanted = beside(shutter("0 0.25"), next_constant, {frame_time, {}, "m.4.obj"});
    const auto scene = read_scene(files, "m.3.obj", wanted);
    EXPECT_TRUE(scene.motion.empty());
    EXPECT_THAT(warnings(scene),
                ElementsAre(HasSubstr("stands still between this frame and 'm.4.obj', which can't be read")));
}

TEST(FilesOfFrames, SayWhereThingsAreInTheNext) {
    auto files = frames(triangle("0"), triangle("4"), triangle("6"));
    const auto scene = read_scene(files, "m.1.obj", beside({}, next_constant, {frame_time, frame_time, "m.2.obj"}));
    ASSERT_TRUE(scene.next);
    EXPECT_EQ(corner(scene.next->motion.shapes.at(0).later.at(0)), 4);
    EXPECT_TRUE(scene.motion.empty()) << "no shutter is open";
}

// From where each is as this frame's shutter opens to where it is as that of the next does.
TEST(FilesOfFrames, SayHowFarThingsMoveFromOpeningToOpening) {
    const auto next_of = [](const std::string& span) {
        auto files = frames(triangle("0"), triangle("4"), triangle("6"));
        auto wanted = beside(shutter(span), next_constant, {frame_time, 2 * frame_time, "m.3.obj"});
        if (span[0] == '-') wanted = beside(wanted, previous_constant, {frame_time, {}, "m.1.obj"});
        const auto scene = read_scene(files, "m.2.obj", wanted);
        return std::pair(corner(scene.shapes.at(0).geometry), corner(scene.next->motion.shapes.at(0).later.at(0)));
    };
    EXPECT_EQ(next_of("0 0.25"), std::pair(4.f, 6.f));
    EXPECT_EQ(next_of("-0.25 0.25"), std::pair(2.f, 5.f)) << "half-way to both";
    EXPECT_EQ(next_of("0.25 0.5"), std::pair(5.f, 7.f)) << "beyond the next the way goes on";
}

TEST(FilesOfFrames, MayBeOneFileThatMoves) {
    const auto scene = [](const SceneConstants& constants) {
        MemoryFiles files;
        files.add("a.pbrt",
                  "Camera \"perspective\"\nTransformTimes 0 10\nWorldBegin\nAttributeBegin\nActiveTransform EndTime\n"
                  "Translate 10 0 0\nActiveTransform All\nShape \"sphere\"\nAttributeEnd");
        return read_scene(files, "a.pbrt", constants);
    };
    const auto at = [](const std::string& seconds) { return SceneConstants{{std::string(time_constant), seconds}}; };
    const auto asked = scene(beside(at("2"), next_constant, {frame_time, 2 + frame_time, ""}));
    EXPECT_FLOAT_EQ(std::get<Sphere>(asked.shapes.at(0).geometry).center.x, 2);
    ASSERT_TRUE(asked.next);
    EXPECT_FLOAT_EQ(std::get<Sphere>(asked.next->motion.shapes.at(0).later.at(0)).center.x, 2.5f);
    auto blurred = at("2");
    blurred.merge(shutter("-0.25 0.25"));
    const auto both = scene(beside(blurred, next_constant, {frame_time, 2 + frame_time, ""}));
    EXPECT_FLOAT_EQ(std::get<Sphere>(both.shapes.at(0).geometry).center.x, 1.75f);
    EXPECT_FLOAT_EQ(std::get<Sphere>(both.next->motion.shapes.at(0).later.at(0)).center.x, 2.25f)
        << "from opening to opening";
}

}  // namespace
}  // namespace lightnet::test::files_of_frames_test
