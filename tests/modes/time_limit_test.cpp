// Runs that end when their time is over, and runs that tell how far they are from a reference.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "tests/modes/daemons.hpp"

namespace lightnet::test {
namespace {

using testing::HasSubstr;
using Words = std::vector<std::string>;

class TimeLimit : public ::testing::Test {
protected:
    // Nothing is as quick as this: one block of samples is rendered, as one always is.
    const Words at_once{"--time-limit", "0.001"};
    const Words small{"--size", "24x18"};

    Launch rendered(const Folder& where, const Words& more, const std::string& graph = "cornell.lua") const {
        Words words = small;
        words.insert(words.end(), more.begin(), more.end());
        const bool own = graph.find('/') != std::string::npos;
        return launch(own ? graph : graph_file(graph), where, words);
    }
    static Words join(Words a, const Words& b) {
        a.insert(a.end(), b.begin(), b.end());
        return a;
    }
    const Folder folder, other;
};

TEST_F(TimeLimit, LeavesThePictureOfAsManySamplesAsAllPixelsHave) {
    const auto expected = rendered(other, {"--samples", "16"}).picture;
    for (const Words& mode : {Words{"--threads", "1"}, Words{"--threads", "2"}, Words{"--local-workers", "1"}}) {
        const auto ended = rendered(folder, join(join({"--samples", "100"}, at_once), mode));
        ASSERT_EQ(ended.code, 0) << ended.said;
        EXPECT_TRUE(ended.picture == expected) << mode.front() << " " << mode.back();
        EXPECT_THAT(ended.said, HasSubstr("the time is over: 16 of 100 samples per pixel; --resume goes on from here"));
        EXPECT_THAT(ended.report, HasSubstr("\"samples\": \"16\""));
    }
}

TEST_F(TimeLimit, LetsALaterRunGoOn) {
    const auto expected = rendered(other, {"--samples", "100"}).picture;
    ASSERT_EQ(rendered(folder, join({"--samples", "100"}, at_once)).code, 0);
    const auto second = rendered(folder, join({"--samples", "100", "--resume", "--threads", "2"}, at_once));
    EXPECT_THAT(second.said, HasSubstr("the time is over: 32 of 100 samples per pixel"));
    EXPECT_TRUE(rendered(folder, {"--samples", "100", "--resume"}).picture == expected);
}

TEST_F(TimeLimit, EndsWhereCellsDecideAboutTheirSamplesAndWhereNodesLearnAnew) {
    folder.write("cornell_box.pbrt", bytes_of(graph_file("cornell_box.pbrt")));
    auto text = bytes_of(graph_file("cornell.lua"));
    const std::string samples = "samples = samples";
    text.insert(text.find(samples), "error = 0.2, least_samples = 32, ");
    const auto adaptive = folder.write("adaptive.lua", text);
    for (const auto& [graph, more] :
         {std::pair(adaptive, Words{"--samples", "128"}),
          std::pair(std::string("progressive.lua"), Words{"-D", "photons=1000", "--samples", "64"})}) {
        const Folder ended, whole;
        const auto expected = rendered(whole, more, graph);
        ASSERT_EQ(expected.code, 0) << expected.said;
        const auto first = rendered(ended, join(more, at_once), graph);
        ASSERT_EQ(first.code, 0) << first.said;
        EXPECT_THAT(first.said, HasSubstr("the time is over"));
        EXPECT_TRUE(rendered(ended, join(more, {"--resume"}), graph).picture == expected.picture) << graph;
    }
}

TEST_F(TimeLimit, IsNoneWhereThereIsTime) {
    const auto ended = rendered(folder, {"--samples", "40", "--time-limit", "100000"});
    EXPECT_TRUE(ended.picture == rendered(other, {"--samples", "40"}).picture);
    EXPECT_EQ(ended.said.find("the time is over"), std::string::npos);
}

TEST_F(TimeLimit, LeavesAPictureThatCanBeExplained) {
    ASSERT_EQ(rendered(folder, join({"--samples", "100"}, at_once)).code, 0);
    Process explain({program("lightnet"), "explain", folder / "picture.exr", "7,9"});
    EXPECT_EQ(explain.wait(), 0) << explain.output();
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
}

TEST_F(TimeLimit, ACurveTellsHowTheErrorFallsOverSamples) {
    const auto reference = rendered(other, {"--samples", "128", "--threads", "1"});
    const std::string file = other / "picture.exr", csv = folder / "error.csv";
    for (const Words& mode : {Words{"--threads", "1"}, Words{"--local-workers", "1"}}) {
        const auto run = rendered(folder, join({"--samples", "128", "--reference", file, "--csv", csv}, mode));
        ASSERT_EQ(run.code, 0) << run.said;
        EXPECT_TRUE(run.picture == reference.picture) << "looking changes nothing";
        const auto lines = lines_of(bytes_of(csv));
        ASSERT_EQ(lines.size(), 5u);
        EXPECT_EQ(lines[0], "samples,seconds,relmse,mse");
        EXPECT_TRUE(lines[1].starts_with("16,")) << lines[1];
        EXPECT_TRUE(lines[3].starts_with("64,")) << lines[3];
        EXPECT_TRUE(lines[4].starts_with("128,") && lines[4].ends_with(",0,0")) << lines[4];
        EXPECT_FALSE(lines[1].ends_with(",0,0")) << lines[1];
        EXPECT_THAT(run.said, HasSubstr("relMSE to " + file + ": 0"));
    }
}

TEST_F(TimeLimit, ACurveWantsAReferenceOfItsSize) {
    ASSERT_EQ(launch(graph_file("cornell.lua"), other, {"--samples", "1", "--size", "8x8"}).code, 0);
    const auto wrong = rendered(folder, {"--samples", "1", "--reference", other / "picture.exr"});
    EXPECT_EQ(wrong.code, 2);
    EXPECT_THAT(wrong.said, HasSubstr("is of 8x8 pixels, and the picture of 24x18"));
    EXPECT_EQ(rendered(folder, {"--csv", folder / "x.csv"}).code, 2) << "of what?";
    const auto mine = folder.write("mine.csv", "my figures");
    ASSERT_EQ(rendered(other, {"--samples", "1"}).code, 0);
    EXPECT_EQ(rendered(folder, {"--samples", "1", "--reference", other / "picture.exr", "--csv", mine}).code, 2);
    EXPECT_EQ(bytes_of(mine), "my figures");
}

}  // namespace
}  // namespace lightnet::test
