// `lightnet render --lighting auto`: trials choose, say so, and choose once.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/base/json.hpp"
#include "core/base/plain_file.hpp"
#include "core/film/exr.hpp"
#include "core/network/graph/graph_film.hpp"
#include "nodes/standard_nodes.hpp"
#include "tests/support/folder.hpp"
#include "tools/cli/auto_lighting.hpp"
#include "tools/cli/launcher.hpp"
#include "tools/cli/lightings.hpp"
#include "tools/support/exit_code.hpp"
#include "tools/support/run_report.hpp"
#include "tools/trials/trial_runs.hpp"

namespace lightnet::auto_lighting_test {
namespace {

using testing::AllOf;
using testing::AnyOf;
using testing::Each;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

const std::string graphs = std::string(LIGHTNET_SOURCE_DIR) + "/graphs/";

/// A launcher whose trials are real, and that remembers what was to be rendered after them.
class Studio {
public:
    int operator()(std::vector<std::string> words) {
        std::ostringstream to_out, to_err;
        Launcher launcher{registry, [&](const RunRequest& request) { return remember(request); }, to_out, to_err};
        launcher.run_tried = launcher.run;
        launcher.try_run = [&](const RunRequest& request, double seconds) {
            tried.push_back(request);
            return trials.run(request, seconds);
        };
        launcher.run_sequence = [&](const Sequence& sequence) {
            for (const auto& frame : sequence.frames) remember(frame);
            return exit_code::done;
        };
        const int code = launcher(words);
        out = to_out.str(), err = to_err.str();
        return code;
    }
    std::string file(const std::string& name) const { return folder.path() / name; }

    const Registry registry{standard_nodes()};
    TrialRuns trials{registry};
    const test::Folder folder;
    std::vector<RunRequest> runs, tried;
    std::string out, err;

private:
    int remember(const RunRequest& request) {
        runs.push_back(request);
        return exit_code::done;
    }
};

TEST(AutoLighting, TriesSmallPicturesOnThisMachineAndKeepsNothing) {
    Studio lightnet;
    ASSERT_EQ(lightnet({"render", graphs + "cornell_box.pbrt", "--lighting", "auto", "--size", "160x160", "--samples",
                        "64", "-o", lightnet.file("x.exr"), "--hosts", "tcp://127.0.0.1:9", "--threads", "2"}),
              0)
        << lightnet.err;
    ASSERT_GE(lightnet.tried.size(), 1u);
    for (const auto& trial : lightnet.tried) {
        EXPECT_NE(trial.mode, Mode::network);
        EXPECT_EQ(trial.progress, ProgressMode::none);
        const auto film = film_of(trial.graph, lightnet.registry);
        EXPECT_LE(film.width * film.height, 46u * 46);
    }
    // Paths of other trials with the first one's random numbers would seem perfect.
    for (std::size_t i = 1; i < lightnet.tried.size(); ++i) EXPECT_NE(lightnet.tried[i].seed, lightnet.tried[0].seed);
    ASSERT_THAT(lightnet.runs, SizeIs(1));
    EXPECT_EQ(lightnet.runs[0].mode, Mode::network) << "the picture is made where it was to be made";
    EXPECT_EQ(film_of(lightnet.runs[0].graph, lightnet.registry).width, 160u);
    EXPECT_TRUE(std::filesystem::is_empty(lightnet.folder.path()));
}

TEST(AutoLighting, SaysWhichAndWhy) {
    Studio lightnet;
    ASSERT_EQ(lightnet({"render", graphs + "cornell_box.pbrt", "--lighting", "auto", "--size", "96x96", "--samples",
                        "16", "-o", lightnet.file("x.exr")}),
              0)
        << lightnet.err;
    const auto& [name, trials] = lightnet.runs.at(0).lighting;
    const Lighting* chosen = find_lighting(name);
    ASSERT_TRUE(chosen && chosen->on_trial) << name;
    EXPECT_TRUE(trials.starts_with(name + " (")) << trials;
    for (const auto& lighting : lightings())
        if (lighting.on_trial) {
            EXPECT_THAT(trials, HasSubstr(lighting.name));
        }
}

// Where caustics make all of the error, trials of others would cost more than they tell.
TEST(AutoLighting, TriesNothingElseWherePathsSayEnough) {
    Studio lightnet;
    ASSERT_EQ(lightnet({"render", graphs + "glass_ball.pbrt", "--lighting", "auto", "--size", "96x96", "--samples",
                        "16", "-o", lightnet.file("x.exr")}),
              0)
        << lightnet.err;
    EXPECT_THAT(lightnet.tried, SizeIs(1));
    EXPECT_EQ(lightnet.runs.at(0).lighting.name, "figure5");
    EXPECT_THAT(lightnet.runs[0].lighting.trials, HasSubstr("figure5 (paths LS+D make"));
}

// It counts, and looks at no clock.
TEST(AutoLighting, SaysTheSameTwice) {
    const auto words = [] {
        Studio lightnet;
        EXPECT_EQ(lightnet({"render", graphs + "glass_ball.pbrt", "--lighting", "auto", "--size", "96x96", "--samples",
                            "32", "-o", lightnet.file("x.exr"), "--threads", "1"}),
                  0)
            << lightnet.err;
        return lightnet.runs.at(0).lighting.name;
    };
    EXPECT_EQ(words(), words());
}

// What it chose can be had by its name.
TEST(AutoLighting, GivesTheRunThatTheNameGives) {
    Studio lightnet;
    const std::vector<std::string> words{"render", graphs + "glass_ball.pbrt", "--size",    "64x64", "--samples", "16",
                                         "-o",     lightnet.file("x.exr"),     "--lighting"};
    auto by_trials = words, by_name = words;
    by_trials.push_back("auto");
    ASSERT_EQ(lightnet(by_trials), 0) << lightnet.err;
    by_name.push_back(lightnet.runs.at(0).lighting.name);
    ASSERT_EQ(lightnet(by_name), 0) << lightnet.err;
    EXPECT_EQ(lightnet.runs[0].graph, lightnet.runs.at(1).graph);
    EXPECT_EQ(lightnet.runs[0].seed, lightnet.runs[1].seed);
    EXPECT_EQ(lightnet.runs[1].lighting.trials, "");
}

TEST(AutoLighting, IsChosenOnceForAllFrames) {
    Studio lightnet;
    ASSERT_EQ(lightnet({"render", graphs + "cornell_box.pbrt", "--lighting", "auto", "--size", "48x48", "--samples",
                        "8", "--frames", "3-5", "-o", lightnet.file("x.####.exr")}),
              0)
        << lightnet.err;
    ASSERT_THAT(lightnet.runs, SizeIs(3));
    const auto count = lightnet.tried.size();
    EXPECT_LE(count, 2u * 5) << "trials of one frame";
    for (const auto& run : lightnet.runs) {
        EXPECT_EQ(run.lighting.name, lightnet.runs[0].lighting.name);
        EXPECT_EQ(run.lighting.trials, lightnet.runs[0].lighting.trials);
    }
}

void write_report_of(const std::string& picture, const std::string& lighting) {
    RunReport report;
    report.outcome = "cancelled";
    report.settings["lighting"] = lighting;
    report.settings["lighting_trials"] = "as it was";
    write_report(report_beside(picture), report);
}

TEST(AutoLighting, StaysWhereAPictureIsGoneOnWith) {
    Studio lightnet;
    const auto picture = lightnet.file("x.exr");
    write_report_of(picture, "progressive");
    ASSERT_EQ(lightnet({"render", graphs + "cornell_box.pbrt", "--lighting", "auto", "--resume", "-o", picture}), 0)
        << lightnet.err;
    EXPECT_THAT(lightnet.tried, IsEmpty());
    EXPECT_EQ(lightnet.runs.at(0).lighting.name, "progressive");
    EXPECT_EQ(lightnet.runs[0].lighting.trials, "as it was");
}

TEST(AutoLighting, OfAnotherFrameStaysWhereFramesAreGoneOnWith) {
    Studio lightnet;
    write_report_of(lightnet.file("x.0004.exr"), "guided");
    ASSERT_EQ(lightnet({"render", graphs + "cornell_box.pbrt", "--lighting", "auto", "--resume", "--frames", "3-5",
                        "-o", lightnet.file("x.####.exr")}),
              0)
        << lightnet.err;
    EXPECT_THAT(lightnet.tried, IsEmpty());
    for (const auto& run : lightnet.runs) EXPECT_EQ(run.lighting.name, "guided");
}

TEST(AutoLighting, OfAReportThatNamesNoneIsTriedAnew) {
    Studio lightnet;
    const auto picture = lightnet.file("x.exr");
    write_report_of(picture, "moonlight");
    EXPECT_EQ(lighting_of_earlier({picture}).name, "");
    std::ofstream(report_beside(picture)) << "no report";
    EXPECT_EQ(lighting_of_earlier({picture, lightnet.file("none.exr")}).name, "");
}

// Rays that shoot photons are counted: in the picture there are hardly any.
TEST(AutoLighting, LeavesThePictureWhatTrialsHavePrepared) {
    Studio lightnet;
    ASSERT_EQ(lightnet({"render", graphs + "glass_ball.pbrt", "--lighting", "figure5", "--size", "8x8", "--samples",
                        "1", "-o", lightnet.file("x.exr"), "--cache", "none", "--progress", "none"}),
              0)
        << lightnet.err;
    RunRequest picture = lightnet.runs.at(0);
    picture.read.reset();  // each reads the scene for itself
    const auto rays = [&] {
        return parse_json(PlainFile(report_beside(lightnet.file("x.exr")), longest_report).text(), {.depth = 64})
            .at("counters")
            .at("rays")
            .number();
    };
    ASSERT_EQ(lightnet.trials.run(picture, 1e9), exit_code::done);
    const double first = rays();
    ASSERT_EQ(lightnet.trials.run_to_end(picture), exit_code::done);
    EXPECT_LT(rays(), first / 4);
    ASSERT_EQ(TrialRuns(lightnet.registry).run_to_end(picture), exit_code::done);
    EXPECT_EQ(rays(), first) << "of other trials there is nothing";
}

// A hosts file that names nodes of one network excludes the others.
TEST(AutoLighting, LeavesOutWhatTheHostsExclude) {
    Studio lightnet;
    const auto hosts = lightnet.folder.write("hosts.lua",
                                             "place 'tcp://127.0.0.1:9' { image = 1, caustics = 1 }\n"
                                             "place 'tcp://127.0.0.1:10' {}\n");
    ASSERT_EQ(lightnet({"render", graphs + "cornell_box.pbrt", "--lighting", "auto", "--size", "48x48", "--samples",
                        "8", "--hosts", hosts, "-o", lightnet.file("x.exr")}),
              0)
        << lightnet.err;
    const auto& [name, trials] = lightnet.runs.at(0).lighting;
    EXPECT_TRUE(name == "irradiance_cache" || name == "figure5") << name;
    EXPECT_THAT(trials, HasSubstr("guided ("));
}

TEST(AutoLighting, SaysWhatIsWrongWithTheScene) {
    Studio lightnet;
    EXPECT_EQ(lightnet({"render", "none.pbrt", "--lighting", "auto"}), 2);
    EXPECT_THAT(lightnet.err, HasSubstr("none.pbrt"));
    EXPECT_EQ(lightnet({"render", graphs + "cornell_box.pbrt", "--lighting", "atuo"}), 2);
    EXPECT_THAT(lightnet.err, HasSubstr("(did you mean 'auto'?)"));
    EXPECT_THAT(lightnet.runs, IsEmpty());
}

// A ball of glass casts a caustic, which paths meet by chance alone, guided or not; photons find it.
TEST(AutoLighting, ShootsPhotonsThroughABallOfGlass) {
    Studio lightnet;
    ASSERT_EQ(lightnet({"render", graphs + "glass_ball.pbrt", "--lighting", "auto", "--size", "160x160", "--samples",
                        "256", "-o", lightnet.file("x.exr")}),
              0)
        << lightnet.err;
    const auto& [name, trials] = lightnet.runs.at(0).lighting;
    EXPECT_TRUE(name == "progressive" || name == "irradiance_cache" || name == "figure5") << trials;
}

// Rough ground below an even sky: it takes many records, and paths have hardly any noise.
TEST(AutoLighting, TracesPathsWhereNothingElsePays) {
    constexpr int side = 160;
    std::string corners, faces;
    std::uint32_t random = 1;
    for (int y = 0; y <= side; ++y)
        for (int x = 0; x <= side; ++x) {
            random = random * 1664525 + 1013904223;
            corners += std::to_string(x * 8.0 / side - 4) + " " + std::to_string((random >> 8) * 0x1p-24 * 0.15) + " " +
                       std::to_string(y * 8.0 / side - 4) + " ";
            if (x == side || y == side) continue;
            const int a = y * (side + 1) + x, b = a + side + 1;
            for (const int corner : {a, b, b + 1, a, b + 1, a + 1}) faces += std::to_string(corner) + " ";
        }
    Studio lightnet;
    const auto scene = lightnet.folder.write("open.pbrt", R"(LookAt 0 2 -4  0 0 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 128 "integer yresolution" 128 "string sensor" "cie1931" "float iso" 100
WorldBegin
LightSource "infinite" "rgb L" [ 1 1 1 ]
Material "diffuse" "rgb reflectance" [ 0.5 0.5 0.5 ]
Shape "trianglemesh" "integer indices" [ )" + faces + "] \"point3 P\" [ " +
                                                              corners + "]\n");
    ASSERT_EQ(lightnet({"render", scene, "--lighting", "auto", "--samples", "512", "-o", lightnet.file("x.exr")}), 0)
        << lightnet.err;
    // a guide that is turned down costs hardly more, and on a busy machine even times of processors vary
    EXPECT_THAT(lightnet.runs.at(0).lighting.name, AnyOf("path_all", "guided")) << lightnet.runs[0].lighting.trials;
}

}  // namespace
}  // namespace lightnet::auto_lighting_test
