// Parts of pictures, previews, and samples where they are needed: in every mode the same bytes.
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/film/exr.hpp"
#include "tests/modes/daemons.hpp"

namespace lightnet::test {
namespace {

using Words = std::vector<std::string>;

Words with(Words words, const Words& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

const std::vector<Words> modes{
    {"--threads", "2", "--tile", "11"}, {"--threads", "3", "--tile", "64"}, {"--local-workers", "2"}};

TEST(Crop, HasThePixelsOfTheWholePictureInEveryMode) {
    const Folder folder;
    const auto graph = graph_file("cornell.lua");
    const Words small{"--size", "48x40", "--samples", "20", "--progress", "none"}, crop{"--crop", "7,5,30,21"};
    ASSERT_EQ(launch(graph, folder, small).code, 0);
    const Picture whole = read_exr(folder / "picture.exr");
    const auto serial = launch(graph, folder, with(with(small, crop), {"--threads", "1"}));
    ASSERT_EQ(serial.code, 0) << serial.said;
    const Picture part = read_exr(folder / "picture.exr");
    EXPECT_EQ(part.x, 7u);
    EXPECT_EQ(part.whole_width, 48u);
    ASSERT_EQ(part.beauty.size(), 23u * 16);
    for (std::size_t i = 0; i < part.beauty.size(); ++i)
        EXPECT_EQ(part.beauty[i], whole.beauty[(5 + i / 23) * 48 + 7 + i % 23]);
    for (const auto& mode : modes)
        EXPECT_TRUE(launch(graph, folder, with(with(small, crop), mode)).picture == serial.picture) << mode[0];
}

// A graph whose cells decide.
std::string adaptive_graph(const Folder& folder) {
    std::ofstream(folder / "adaptive.lua")
        << "scene = Scene { '" << graph_file("cornell_box.pbrt") << "' }\n"
        << "light = PathTracing { paths = 'all' }\n"
        << "image = RayTracer { light, scene = scene, samples = 200, error = 0.04, least_samples = 32,\n"
        << "                    film = { 44, 36 } }\n";
    return folder / "adaptive.lua";
}

TEST(Refinement, GivesTheSameBytesInEveryMode) {
    const Folder folder;
    const auto graph = adaptive_graph(folder);
    const Words quiet{"--progress", "none"};
    const auto serial = launch(graph, folder, with(quiet, {"--threads", "1"}));
    ASSERT_EQ(serial.code, 0) << serial.said;
    const Picture picture = read_exr(folder / "picture.exr");
    ASSERT_EQ(picture.samples.size(), 44u * 36);
    EXPECT_NE(*std::min_element(picture.samples.begin(), picture.samples.end()),
              *std::max_element(picture.samples.begin(), picture.samples.end()));
    for (const auto& mode : modes) {
        const auto other = launch(graph, folder, with(quiet, mode));
        EXPECT_EQ(other.code, 0) << other.said;
        EXPECT_TRUE(other.picture == serial.picture) << mode[0];
    }
}

TEST(Preview, IsWrittenAndLeavesThePictureAsItIs) {
    const Folder folder;
    const auto graph = graph_file("cornell.lua");
    const Words small{"--size", "64x64", "--samples", "100", "--tile", "8", "--progress", "none"};
    const auto plain = launch(graph, folder, small);
    ASSERT_EQ(plain.code, 0) << plain.said;
    const auto shown = launch(graph, folder, with(small, {"--preview", "0.01"}));
    EXPECT_TRUE(shown.picture == plain.picture);
    EXPECT_EQ(read_exr(folder / "picture.exr").done, 1);
}

TEST(Preview, IsWhatIsLeftOfACancelledRun) {
    const Folder folder;
    Process run(launch_words(graph_file("cornell.lua"), folder / "picture.exr",
                             {"--size", "64x64", "--samples", "1000000", "--preview", "0.05", "--progress", "json"}));
    ASSERT_TRUE(run.wait_for("shows the picture so far")) << run.output();
    EXPECT_NE(bytes_of(folder / "picture.run.json").find("\"preview\""), std::string::npos);
    run.signal(SIGINT);
    EXPECT_EQ(run.wait(), 130);
    // Where all pixels have as many samples at that moment, it is a whole picture of so many.
    const Picture picture = read_exr(folder / "picture.exr");
    const auto report = nlohmann::json::parse(bytes_of(folder / "picture.run.json"));
    const int samples = std::stoi(report.at("settings").at("samples").get<std::string>());
    EXPECT_GT(picture.done, 0);
    EXPECT_TRUE(picture.done < 1 || samples < 1000000) << picture.done << " of " << samples;
    EXPECT_EQ(report.at("outcome"), "cancelled");
}

}  // namespace
}  // namespace lightnet::test
