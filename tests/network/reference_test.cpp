// Pictures against references that were made by other renderers, with their tolerances. Where there are none: skipped.
//
// The bound: a picture of n samples differs from the truth by bias and noise. The mean over the whole picture has
// hardly any noise; of the mean difference of 16×16 blocks the test allows the reference's tolerance plus the noise
// that two halves of the run, rendered with different seeds, show between themselves.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "core/film/compare.hpp"
#include "core/film/exr.hpp"
#include "tests/network/daemons.hpp"

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
        const char* shared = std::getenv("LIGHTNET_SHARED");
        if (!shared || !fs::exists(fs::path(shared) / "reference" / GetParam().picture))
            GTEST_SKIP() << "the reference pictures are not here";
        home = fs::path(shared);
        // The reference's main file beside the scene's other files.
        const auto put_all_of = [&](const fs::path& from) {
            for (const auto& entry : fs::directory_iterator(from)) {
                std::error_code there_already;
                fs::create_symlink(entry.path(), folder / entry.path().filename(), there_already);
            }
        };
        put_all_of((home / "reference" / GetParam().main_file).parent_path());
        if (!GetParam().scene.empty()) put_all_of(home / "scenes" / GetParam().scene);
    }

    Picture render(int seed) {
        const auto& r = GetParam();
        const auto scene = folder / fs::path(r.main_file).filename().string();
        const auto run =
            launch(graph_file("path.lua"), folder,
                   {"-D", "file=" + scene.string(), "--size", std::to_string(r.width) + "x" + std::to_string(r.height),
                    "--samples", std::to_string(r.samples / 2), "--seed", std::to_string(seed), "--threads", "2",
                    "--progress", "none"});
        EXPECT_EQ(run.code, 0) << run.said;
        return read_exr(folder / "picture.exr");
    }

    fs::path home;
    Folder folder;
};

TEST_P(References, AgreeWithinTheirTolerances) {
    const auto& r = GetParam();
    Picture a = render(1);
    const Picture b = render(2);
    const double noise = compare(a, b).block_difference / 2;  // of the mean of both
    for (std::size_t i = 0; i < a.beauty.size(); ++i) a.beauty[i] = (a.beauty[i] + b.beauty[i]) * 0.5f;
    const auto difference = compare(read_exr(home / "reference" / r.picture), a);
    for (const float ratio : {difference.mean_ratio.r, difference.mean_ratio.g, difference.mean_ratio.b})
        EXPECT_NEAR(ratio, 1, r.mean);
    EXPECT_LT(difference.block_difference, r.blocks + 1.5 * noise) << "noise of the run: " << noise;
    RecordProperty("mean_ratio", std::to_string(difference.mean_ratio.g));
    RecordProperty("block_difference", std::to_string(difference.block_difference));
}

INSTANTIATE_TEST_SUITE_P(Strict, References,
                         ::testing::Values(Reference{"cornell_grey", "cornell_grey.mits_path_2048.exr",
                                                     "cornell_grey.pbrt", "", 256, 256, 64, 0.003, 0.005},
                                           Reference{"cornell_rgb", "cornell_rgb.mits_path_1024.exr",
                                                     "cornell_rgb.pbrt", "", 256, 256, 64, 0.003, 0.005},
                                           Reference{"furnace05", "furnace05.analytic.exr", "furnace05.pbrt", "", 256,
                                                     256, 32, 0.003, 0.005},
                                           Reference{"furnace08", "furnace08.analytic.exr", "furnace08.pbrt", "", 256,
                                                     256, 32, 0.003, 0.005}),
                         [](const auto& reference) { return reference.param.name; });

// The same scenes, as Mitsuba's files say them.
INSTANTIATE_TEST_SUITE_P(Mitsuba, References,
                         ::testing::Values(Reference{"cornell_grey", "cornell_grey.mits_path_2048.exr",
                                                     "cornell_grey.path.xml", "", 256, 256, 64, 0.003, 0.005},
                                           Reference{"cornell_rgb", "cornell_rgb.mits_path_1024.exr",
                                                     "cornell_rgb.path.xml", "", 256, 256, 64, 0.003, 0.005},
                                           Reference{"furnace08", "furnace08.analytic.exr", "furnace08.path.xml", "",
                                                     256, 256, 32, 0.003, 0.005}),
                         [](const auto& reference) { return reference.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Real, References,
    ::testing::Values(Reference{"veach_mis", "scenes/veach-mis/veach-mis.exr", "scenes/veach-mis/veach-mis.pbrt",
                                "veach-mis-pbrt", 320, 240, 64, 0.016, 0.027},
                      Reference{"cornell_box", "scenes/cornell-box/cornell-box.exr",
                                "scenes/cornell-box/cornell-box.pbrt", "cornell-box-pbrt", 320, 320, 64, 0.005, 0.008},
                      Reference{"bmw_m6", "scenes/bmw-m6/bmw-m6.exr", "scenes/bmw-m6/bmw-m6.pbrt", "bmw-m6-pbrt", 320,
                                228, 64, 0.028, 0.045}),
    [](const auto& reference) { return reference.param.name; });

}  // namespace
}  // namespace lightnet::test
