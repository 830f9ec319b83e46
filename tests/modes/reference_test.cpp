// Pictures against references that were made by other renderers, with their tolerances: those that ship with the
// project, and others where a folder with them is known (references.hpp).
//
// The bound: a picture of n samples differs from the truth by bias and noise. The mean over the whole picture has
// hardly any noise; of the mean difference of 16×16 blocks the test allows the reference's tolerance plus the noise
// that two halves of the run, rendered with different seeds, show between themselves. Each test prints its row of the
// table; with LIGHTNET_LARGE, of all references (ctest -L slow).
#include <gtest/gtest.h>

#include <algorithm>
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

struct Reference {
    std::string name;
    std::string picture, main_file;  // under the folder of references
    std::string scene;               // folder of the scene's other files, or empty
    int width, height, samples;
    double mean, blocks;  // tolerances of a converged picture
};

std::ostream& operator<<(std::ostream& out, const Reference& reference) { return out << reference.name; }

class References : public ::testing::TestWithParam<Reference> {
protected:
    void SetUp() override {
        // The reference's main file beside the scene's other files.
        const auto put_all_of = [&](const fs::path& from) {
            for (const auto& entry : fs::directory_iterator(from)) {
                std::error_code there_already;
                fs::create_symlink(entry.path(), folder / entry.path().filename(), there_already);
            }
        };
        put_all_of(reference_file(GetParam().main_file).value().parent_path());
        if (!GetParam().scene.empty()) put_all_of(shared_file("scenes/" + GetParam().scene).value());
    }

    Picture render(int seed, const std::vector<std::string>& mode) {
        const auto& r = GetParam();
        const auto scene = folder / fs::path(r.main_file).filename().string();
        const auto run =
            launch(graph_file("path.lua"), folder,
                   {"-D", "file=" + scene.string(), "--size", std::to_string(r.width) + "x" + std::to_string(r.height),
                    "--samples", std::to_string(r.samples / 2), "--seed", std::to_string(seed), mode[0], mode[1],
                    "--progress", "none"},
                   slowdown * std::chrono::minutes(10));
        EXPECT_EQ(run.code, 0) << run.said;
        return read_exr(folder / "picture.exr");
    }

    Folder folder;
};

/// Of the mean of two halves, how far its noise may take the ratio of means: one standard deviation.
double noise_of_mean(const Picture& a, const Picture& b) {
    double mean_a = 0, mean_b = 0;
    for (std::size_t i = 0; i < a.beauty.size(); ++i)
        mean_a += luminance(a.beauty[i]), mean_b += luminance(b.beauty[i]);
    return std::abs(mean_a - mean_b) / (mean_a + mean_b);
}

TEST_P(References, AgreeWithinTheirTolerances) {
    const auto& r = GetParam();
    Picture a = render(1, {"--threads", "2"});
    const Picture b = render(2, {"--local-workers", "2"});
    const double noise = compare(a, b).block_difference / 2;  // of the mean of both
    const double mean_noise = noise_of_mean(a, b);
    for (std::size_t i = 0; i < a.beauty.size(); ++i) a.beauty[i] = (a.beauty[i] + b.beauty[i]) * 0.5f;
    const auto difference = compare(read_exr(reference_file(r.picture).value()), a);
    const Rgb ratio = difference.mean_ratio;
    for (const float channel : {ratio.r, ratio.g, ratio.b}) EXPECT_NEAR(channel, 1, r.mean);
    EXPECT_LT(difference.block_difference, r.blocks + 1.5 * noise) << "noise of the run: " << noise;
    std::printf(
        "%-21s %4d samples  mean ratio %.4f %.4f %.4f (noise %.4f, tolerance %.3f)  blocks %.4f (noise %.4f, "
        "tolerance %.3f)\n",
        r.name.c_str(), r.samples, double{ratio.r}, double{ratio.g}, double{ratio.b}, mean_noise, r.mean,
        difference.block_difference, noise, r.blocks);
}

std::string name_of(const testing::TestParamInfo<Reference>& reference) {
    std::string name = reference.param.name;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
}

Reference strict(std::string name, const std::string& made_by, int samples, double mean = 0.003,
                 double blocks = 0.005) {
    return {name, name + "." + made_by + ".exr", name + ".pbrt", "", 256, 256, samples, mean, blocks};
}

Reference from_mitsuba(Reference reference) {
    reference.main_file = reference.name + ".path.xml";
    return reference;
}

/// Of a scene that others made, in whose folder this is the main file.
Reference real(std::string name, const std::string& folder, int height, int samples, double mean, double blocks) {
    const std::string path = "scenes/" + folder + "/" + name;
    return {name, path + ".exr", path + ".pbrt", folder + "-pbrt", 320, height, samples, mean, blocks};
}

std::vector<Reference> here(std::vector<Reference> all) {
    return that_are_here(std::move(all), [](const Reference& one) { return reference_file(one.picture); });
}

// Strict ones, as Mitsuba's files say them.
INSTANTIATE_TEST_SUITE_P(Mitsuba, References,
                         ::testing::ValuesIn(here({from_mitsuba(strict("cornell_grey", "mits_path_2048", 64)),
                                                   from_mitsuba(strict("cornell_rgb", "mits_path_1024", 64)),
                                                   from_mitsuba(strict("furnace08", "analytic", 32))})),
                         name_of);

#if defined(LIGHTNET_LARGE) && defined(LIGHTNET_SHARED_FOLDER)
// Tungsten's picture of this file has direct light only, and the laws of facets and masking that Mitsuba has: strip by
// strip, the metal plates must be as bright.
TEST(VeachMis, HasThePlatesOfAnotherRenderersPicture) {
    const fs::path scene = LIGHTNET_SHARED_FOLDER "/scenes/veach-mis-mitsuba";
    const Folder folder;
    folder.write("graph.lua", "scene = Scene { '" + (scene / "scene.xml").string() +
                                  "' }\nlight = DirectLighting {}\nimage = RayTracer { light, scene = scene, "
                                  "samples = 16, film = { 1280, 720, file = 'picture.exr' } }\n");
    const auto run = launch(folder / "graph.lua", folder, {"--progress", "none"}, slowdown * std::chrono::minutes(5));
    ASSERT_EQ(run.code, 0) << run.said;
    const Picture ours = read_exr(folder / "picture.exr"), theirs = read_exr(scene / "TungstenRender.exr");
    ASSERT_EQ(ours.beauty.size(), theirs.beauty.size());
    const std::size_t strip = std::size_t{1280} * 40;
    for (std::size_t first = 0; first < ours.beauty.size(); first += strip) {
        double a = 0, b = 0;
        for (std::size_t i = first; i < first + strip; ++i)
            a += luminance(ours.beauty[i]), b += luminance(theirs.beauty[i]);
        EXPECT_NEAR(a / b, 1, 0.006) << "from row " << first / 1280;
    }
}
#endif

#ifndef LIGHTNET_LARGE
INSTANTIATE_TEST_SUITE_P(
    Strict, References,
    ::testing::ValuesIn(here({strict("cornell_grey", "mits_path_2048", 64), strict("cornell_rgb", "mits_path_1024", 64),
                              strict("furnace05", "analytic", 32), strict("furnace08", "analytic", 32)})),
    name_of);

INSTANTIATE_TEST_SUITE_P(Real, References,
                         ::testing::ValuesIn(here({real("veach-mis", "veach-mis", 240, 64, 0.016, 0.027),
                                                   real("cornell-box", "cornell-box", 320, 64, 0.005, 0.008),
                                                   real("bmw-m6", "bmw-m6", 228, 64, 0.028, 0.045)})),
                         name_of);
#else
INSTANTIATE_TEST_SUITE_P(
    Strict, References,
    ::testing::ValuesIn(here(
        {strict("cornell_grey", "mits_path_2048", 128), strict("cornell_rgb", "mits_path_1024", 128),
         strict("caustic", "mits_bdpt_1280", 256, 0.01, 0.015), strict("indirect", "mits_path_2048", 256, 0.003, 0.015),
         strict("furnace05", "analytic", 32), strict("furnace08", "analytic", 32), strict("terrain", "combined", 64)})),
    name_of);

INSTANTIATE_TEST_SUITE_P(Real, References,
                         ::testing::ValuesIn(here({real("bmw-m6", "bmw-m6", 228, 64, 0.028, 0.045),
                                                   real("cornell-box-silver", "cornell-box", 320, 64, 0.005, 0.009),
                                                   real("cornell-box-specular", "cornell-box", 320, 128, 0.005, 0.015),
                                                   real("cornell-box", "cornell-box", 320, 64, 0.005, 0.008),
                                                   real("smallpt", "cornell-box", 320, 128, 0.005, 0.009),
                                                   real("living-room", "living-room", 180, 256, 0.015, 0.072),
                                                   real("staircase2", "staircase2", 320, 64, 0.015, 0.035),
                                                   real("veach-ajar", "veach-ajar", 180, 256, 0.008, 0.035),
                                                   real("veach-mis-colorized", "veach-mis", 240, 64, 0.023, 0.029),
                                                   real("veach-mis", "veach-mis", 240, 64, 0.016, 0.027)})),
                         name_of);
#endif

}  // namespace
}  // namespace lightnet::test
