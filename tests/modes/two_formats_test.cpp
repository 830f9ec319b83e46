// The same scene in two formats gives the same picture, but for noise: what runs with other seeds show between
// themselves. Some of these scenes ship with the project (references.hpp).
//
// Real scenes that exist in both formats often have other materials in each; those are shown in clay, which leaves
// their shapes, lights and cameras.
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "core/film/compare.hpp"
#include "core/film/exr.hpp"
#include "tests/modes/daemons.hpp"
#include "tests/support/references.hpp"

namespace lightnet::test {
namespace {

namespace fs = std::filesystem;

struct Pair {
    std::string name, pbrt, mitsuba;  // references, or under the shared folder
    int size, samples;
    bool clay = false;
};

std::ostream& operator<<(std::ostream& out, const Pair& pair) { return out << pair.name; }

std::optional<fs::path> file_of(const std::string& name) {
    const auto reference = reference_file(name);
    return reference ? reference : shared_file(name);
}

class TwoFormats : public ::testing::TestWithParam<Pair> {
protected:
    void SetUp() override {
        const std::string clay = GetParam().clay ? ", material = 'clay'" : "";
        folder.write("graph.lua", "file = ''\nscene = Scene { file" + clay +
                                      " }\nlighting = PathTracing { samples = 1, paths = 'all' }\n"
                                      "image = RayTracer { lighting, scene = scene, samples = 1, film = { 64, 64, "
                                      "file = 'picture.exr' } }\n");
    }

    Picture render(const std::string& scene, int seed) {
        const std::string size = std::to_string(GetParam().size);
        const auto run = launch(folder / "graph.lua", folder,
                                {"-D", "file=" + file_of(scene).value().string(), "--size", size + "x" + size,
                                 "--samples", std::to_string(GetParam().samples), "--seed", std::to_string(seed),
                                 "--threads", "2", "--progress", "none"},
                                slowdown * std::chrono::minutes(10));
        EXPECT_EQ(run.code, 0) << run.said;
        return read_exr(folder / "picture.exr");
    }

    Folder folder;
};

Picture mean(const std::array<Picture, 2>& halves) {
    Picture result = halves[0];
    for (std::size_t i = 0; i < result.beauty.size(); ++i)
        result.beauty[i] = (halves[0].beauty[i] + halves[1].beauty[i]) * 0.5f;
    return result;
}

// Each picture is the mean of two halves, so that the difference of two pictures has the noise of one half.
TEST_P(TwoFormats, GiveTheSamePicture) {
    const auto& p = GetParam();
    const std::array pbrt{render(p.pbrt, 1), render(p.pbrt, 2)}, mitsuba{render(p.mitsuba, 3), render(p.mitsuba, 4)};
    const double noise =
        (compare(pbrt[0], pbrt[1]).block_difference + compare(mitsuba[0], mitsuba[1]).block_difference) /
        (2 * std::sqrt(2.0));
    const auto difference = compare(mean(pbrt), mean(mitsuba));
    const Rgb ratio = difference.mean_ratio;
    for (const float channel : {ratio.r, ratio.g, ratio.b}) EXPECT_NEAR(channel, 1, 0.004);
    EXPECT_LT(difference.block_difference, 1.3 * noise + 0.001);
    std::printf("%-14s mean ratio %.4f %.4f %.4f  blocks %.4f, of which by noise %.4f\n", p.name.c_str(),
                double{ratio.r}, double{ratio.g}, double{ratio.b}, difference.block_difference, noise);
}

Pair strict(const std::string& name) { return {name, name + ".pbrt", name + ".path.xml", 128, 64}; }

INSTANTIATE_TEST_SUITE_P(
    Scenes, TwoFormats,
    ::testing::ValuesIn(that_are_here(std::vector<Pair>{strict("cornell_grey"), strict("cornell_rgb"),
                                                        strict("indirect"), strict("furnace08"),
                                                        Pair{"staircase2", "scenes/staircase2-pbrt/staircase2.pbrt",
                                                             "scenes/staircase2-mitsuba/scene.xml", 192, 48, true}},
                                      [](const Pair& pair) { return file_of(pair.mitsuba); })),
    [](const auto& pair) { return pair.param.name; });

}  // namespace
}  // namespace lightnet::test
