// Groups of lamps in scenes of others, in three formats. CMake makes these tests where a folder with them is known.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>

#include "core/film/exr.hpp"
#include "tests/modes/daemons.hpp"

namespace lightnet::test {
namespace {

namespace fs = std::filesystem;

struct RealScene {
    std::string name, file, groups, gain;  // the file under the shared folder
};

std::ostream& operator<<(std::ostream& out, const RealScene& scene) { return out << scene.name; }

class RealGroups : public ::testing::TestWithParam<RealScene> {
protected:
    std::string graph(bool grouped) {
        const std::string groups = grouped ? ", groups = true" : "";
        return folder.write(grouped ? "grouped.lua" : "plain.lua",
                            "file = ''\nscene = Scene { file, groups = { " + GetParam().groups +
                                " } }\ndirect = DirectLighting { samples = 1" + groups +
                                " }\nbounce = PathTracing { samples = 1" + groups +
                                " }\nlight = Combine { direct, bounce }\nimage = RayTracer { light" + groups +
                                ", scene = scene, film = { 48, 32 } }\n");
    }
    Launch rendered(bool grouped, std::vector<std::string> more) {
        more.insert(more.end(), {"-D", "file=" + scene.string(), "--samples", "4", "--progress", "none"});
        auto run = launch(graph(grouped), folder, more, slowdown * std::chrono::minutes(10));
        EXPECT_EQ(run.code, 0) << run.said;
        return run;
    }

    const fs::path scene = fs::path(LIGHTNET_SHARED_FOLDER) / GetParam().file;
    Folder folder;
};

TEST_P(RealGroups, AreTheSameInAllModesAndMixExactly) {
    const auto serial = rendered(true, {"--threads", "1"});
    EXPECT_TRUE(rendered(true, {"--local-workers", "2"}).picture == serial.picture);
    Process remix({program("lightnet"), "remix", folder / "picture.exr", GetParam().gain, "-o", folder / "mixed.exr"});
    ASSERT_EQ(remix.wait(), 0) << remix.output();
    EXPECT_TRUE(rendered(true, {"--threads", "2", "--gain", GetParam().gain}).picture ==
                bytes_of(folder / "mixed.exr"));
}

// The same paths, whose light is added up in another order.
TEST_P(RealGroups, AddUpToThePictureWithoutGroups) {
    rendered(true, {"--threads", "2"});
    const Picture grouped = read_exr(folder / "picture.exr");
    rendered(false, {"--threads", "2"});
    const Picture plain = read_exr(folder / "picture.exr");
    ASSERT_EQ(grouped.beauty.size(), plain.beauty.size());
    for (std::size_t i = 0; i < plain.beauty.size(); ++i)
        for (const auto part : {&Rgb::r, &Rgb::g, &Rgb::b})
            EXPECT_NEAR(grouped.beauty[i].*part, plain.beauty[i].*part, 1e-4f * (1e-3f + plain.beauty[i].*part)) << i;
}

INSTANTIATE_TEST_SUITE_P(Scene, RealGroups,
                         ::testing::Values(RealScene{"living_room", "scenes/living-room-pbrt/living-room.pbrt",
                                                     "sky = 'environment'", "sky=0.3,0.4,0.9"},
                                           RealScene{"staircase2", "scenes/staircase2-mitsuba/scene.xml",
                                                     "low = { 'lamp', 'lamp2', 'lamp3' }", "low=0.5"},
                                           RealScene{"emissive",
                                                     "scenes/gltf-EmissiveStrengthTest/glTF/EmissiveStrengthTest.gltf",
                                                     "strong = { 'Emit16', 'Emit8' }, weak = 'Emit1'", "strong=0.1"}),
                         [](const auto& scene) { return scene.param.name; });

}  // namespace
}  // namespace lightnet::test
