// What a graph may change about its scene.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/network/graph/check.hpp"
#include "core/network/graph/describe.hpp"
#include "tests/support/fake_registry.hpp"
#include "tests/support/parse.hpp"

namespace lightnet::check_scene_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

/// All that is wrong with `Scene { 'box.pbrt', … }`, a line each.
std::string problems_of(const std::string& changes) {
    const Graph graph = test::parse("sky = Ambient {}\nscene = Scene { 'box.pbrt', " + changes +
                                    " }\nimage = RayTracer { sky, scene = scene, film = { 8, 4 } }");
    std::string text;
    for (const auto& problem : examine(graph, test::fake_registry()).problems) text += to_string(problem) + "\n";
    return text;
}

TEST(CheckScene, TakesAllThatItDescribes) {
    EXPECT_THAT(
        problems_of(
            "camera = { from = { 1, 2, 3 }, to = { 0, 0, 0 }, up = { 0, 1, 0 }, fov = 40, lens = 0.1, focus = 4 },"
            "environment = 'sky.exr', environment_scale = 2, exposure = -1.5, material = 'clay'"),
        IsEmpty());
    EXPECT_THAT(problems_of("environment = { 0.5, 0.6, 0.7 }"), IsEmpty());
    EXPECT_THAT(problems_of("sky = { towards = { 1, 2, 3 }, turbidity = 2.5, albedo = 0, scale = 9, sun_scale = 0, "
                            "sun_angle = 1 }"),
                IsEmpty());
    EXPECT_THAT(problems_of("sky = { turbidity = 11 }"), HasSubstr("'turbidity' is 11, but must be 1 … 10"));
    EXPECT_THAT(problems_of("constants = { spp = 16, wood = 'oak.jpg', hidden = true }"), IsEmpty());
    EXPECT_THAT(problems_of("constants = { spp = { 16 } }"),
                HasSubstr("'constants': 'spp' must be a number, a text or a flag, not a table"));
}

TEST(CheckScene, SuggestsTheEntryYouMeant) {
    EXPECT_THAT(problems_of("camra = {}"), HasSubstr("unknown parameter 'camra' (did you mean 'camera'?)"));
    EXPECT_THAT(problems_of("camera = { form = { 1, 2, 3 } }"),
                HasSubstr(":2: Scene 'scene': 'camera': unknown entry 'form' (did you mean 'from'?)"));
    EXPECT_THAT(problems_of("material = 'clya'"), HasSubstr("'material' can't be 'clya' (did you mean 'clay'?)"));
}

TEST(CheckScene, SaysWhatEachEntryMustBe) {
    EXPECT_THAT(problems_of("camera = 3"), HasSubstr("'camera' must be a table with names, not a number"));
    EXPECT_THAT(problems_of("camera = { 3 }"), HasSubstr("'camera' must be a table with names"));
    EXPECT_THAT(problems_of("camera = { from = { 1, 2 } }"), HasSubstr("'camera': 'from' must have 3 numbers, not 2"));
    EXPECT_THAT(problems_of("camera = { fov = 180 }"),
                HasSubstr("'camera': 'fov' is 180, but must be 0.001 … 179 degrees"));
    EXPECT_THAT(problems_of("camera = { lens = -1, focus = 'near' }"),
                testing::AllOf(HasSubstr("'lens' is -1"), HasSubstr("'focus' must be a number, not a text")));
    EXPECT_THAT(problems_of("environment = { 1, 2 }"), HasSubstr("'environment' must be a colour of three numbers"));
    EXPECT_THAT(problems_of("environment = { 1, 2, -3 }"),
                HasSubstr("'environment' must be a colour of three numbers"));
    EXPECT_THAT(problems_of("environment = true"), HasSubstr("'environment' must be the name of a file or a colour"));
    EXPECT_THAT(problems_of("environment_scale = -1"), HasSubstr("'environment_scale' is -1"));
    EXPECT_THAT(problems_of("exposure = 100"), HasSubstr("'exposure' is 100"));
}

TEST(Describe, TellsTheEntriesOfATable) {
    EXPECT_THAT(describe(*test::fake_registry().find("Scene")),
                HasSubstr("fov    field of view: angle across the shorter side of the image: number, in degrees, "
                          "optional, 0.001 … 179\n"));
}

}  // namespace
}  // namespace lightnet::check_scene_test
