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
    const Words small{"--size", "48x36"}, many{"--samples", "10000000"};

    Launch rendered(const Folder& where, const Words& more, const std::string& graph = "cornell.lua") const {
        const bool own = graph.find('/') != std::string::npos;
        return launch(own ? graph : graph_file(graph), where, join(small, more));
    }
    // A run of more samples than there is time for. However busy the machine: a time in which some are done.
    Launch ended(const Folder& where, const Words& more, const std::string& graph = "cornell.lua") const {
        Launch run;
        for (const auto* seconds : {"0.5", "2", "8", "32"}) {
            run = rendered(where, join(join(many, more), {"--time-limit", seconds}), graph);
            if (run.code == 0) break;
            EXPECT_TRUE(run.code == 1 || run.code == 3) << run.said;
            const bool no_worker = run.code == 3;
            EXPECT_THAT(run.said, HasSubstr(no_worker ? "no worker can be reached"
                                                      : "the time was over before every pixel had a sample"));
        }
        EXPECT_EQ(run.code, 0) << run.said;
        return run;
    }
    // As the run says.
    static std::string samples_of(const Launch& run) {
        const std::string before = "the time is over: ";
        const auto at = run.said.find(before);
        EXPECT_NE(at, std::string::npos) << run.said;
        if (at == std::string::npos) return "0";
        const auto from = at + before.size();
        return run.said.substr(from, run.said.find(' ', from) - from);
    }
    static Words join(Words a, const Words& b) {
        a.insert(a.end(), b.begin(), b.end());
        return a;
    }
    const Folder folder, other;
};

TEST_F(TimeLimit, LeavesThePictureOfAsManySamplesAsItSays) {
    for (const Words& mode : {Words{"--threads", "1"}, Words{"--threads", "2"}, Words{"--local-workers", "1"}}) {
        const auto run = ended(folder, mode);
        const auto samples = samples_of(run);
        EXPECT_TRUE(rendered(other, {"--samples", samples}).picture == run.picture) << samples << " " << mode.front();
        EXPECT_THAT(run.said,
                    HasSubstr(samples + (samples == "1" ? " sample" : " samples") + " per pixel of 10000000"));
        EXPECT_THAT(run.report, HasSubstr("\"samples\": \"" + samples + "\""));
    }
}

TEST_F(TimeLimit, LetsALaterRunGoOn) {
    const auto first = ended(folder, {});
    const auto second = ended(folder, {"--resume", "--threads", "2"});
    EXPECT_GE(std::stoi(samples_of(second)), std::stoi(samples_of(first)));
    const auto more = std::to_string(2 * std::stoi(samples_of(second)) + 200);
    const auto expected = rendered(other, {"--samples", more});
    EXPECT_TRUE(rendered(folder, {"--samples", more, "--resume"}).picture == expected.picture) << more;
}

TEST_F(TimeLimit, EndsWhereCellsDecideAboutTheirSamplesAndWhereNodesLearnAnew) {
    folder.write("cornell_box.pbrt", bytes_of(graph_file("cornell_box.pbrt")));
    auto text = bytes_of(graph_file("cornell.lua"));
    const std::string samples = "samples = samples";
    text.insert(text.find(samples), "error = 0.001, least_samples = 32, ");
    const auto adaptive = folder.write("adaptive.lua", text);
    for (const auto& [graph, more] :
         {std::pair(adaptive, Words{}), std::pair(std::string("progressive.lua"), Words{"-D", "photons=1000"})}) {
        const Folder one, two;
        const auto run = ended(one, more, graph);
        // Where cells decide, it is the mean that is said; the report says how many any pixel may have.
        const std::string before = "\"samples\": \"";
        const auto at = run.report.find(before) + before.size();
        const auto most = run.report.substr(at, run.report.find('"', at) - at);
        EXPECT_TRUE(rendered(two, join(more, {"--samples", most}), graph).picture == run.picture) << graph << most;
    }
}

// Of millions of pixels, none has its first sample in so short a time.
TEST_F(TimeLimit, EndsTheRunWhereThereIsNoTimeForAnything) {
    for (const Words& mode : {Words{"--threads", "1"}, Words{"--threads", "2"}, Words{"--local-workers", "1"}}) {
        Process run(launch_words(graph_file("cornell.lua"), folder / "picture.exr",
                                 join(mode, {"--size", "2000x1500", "--time-limit", "0.05"})));
        const int code = run.wait();
        // Workers may not even have come.
        EXPECT_TRUE(code == 1 || (code == 3 && mode.front() == "--local-workers")) << run.output();
        if (code == 1) {
            EXPECT_THAT(run.output(), HasSubstr("the time was over before every pixel had a sample"));
        }
    }
}

TEST_F(TimeLimit, EndsARunWhoseNodesPrepare) {
    for (const Words& mode : {Words{"--threads", "1"}, Words{"--threads", "2"}}) {
        const auto run =
            rendered(folder, join(mode, {"--time-limit", "0.02", "-D", "photons=10000000"}), "progressive.lua");
        EXPECT_EQ(run.code, 1) << run.said;
        EXPECT_THAT(run.said, HasSubstr("the time was over before every pixel had a sample: no picture was written"));
    }
}

TEST_F(TimeLimit, BoundsTheWaitForAHostThatServesOthers) {
    const Daemon busy(folder);
    const auto hosts = folder.write("hosts.lua", "place '" + busy.endpoint + "' {}");
    Process first(launch_words(graph_file("cornell.lua"), other / "first.exr",
                               join(many, {"--hosts", hosts, "--progress", "json"})));
    ASSERT_TRUE(first.wait_for("\"event\":\"progress\"")) << first.output();
    for (const Words& bound : {Words{"--wait", "1"}, Words{"--time-limit", "1"}}) {
        const auto run = rendered(folder, join(bound, {"--hosts", hosts, "--samples", "1"}));
        EXPECT_EQ(run.code, 3) << run.said;
        EXPECT_THAT(run.said, HasSubstr("no worker was free in time"));
        EXPECT_THAT(run.said, HasSubstr("is busy"));
    }
}

TEST_F(TimeLimit, IsNoneWhereThereIsTime) {
    const auto ended = rendered(folder, {"--samples", "40", "--time-limit", "100000"});
    EXPECT_TRUE(ended.picture == rendered(other, {"--samples", "40"}).picture);
    EXPECT_EQ(ended.said.find("the time is over"), std::string::npos);
}

TEST_F(TimeLimit, LeavesAPictureThatCanBeExplained) {
    ASSERT_EQ(ended(folder, {}).code, 0);
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

// The number behind a name, in text that is like JSON.
double number_after(const std::string& text, const std::string& name) {
    const auto at = text.find("\"" + name + "\":");
    EXPECT_NE(at, std::string::npos) << name << " in " << text;
    return at == std::string::npos ? -1 : std::stod(text.substr(at + name.size() + 3));
}

TEST_F(TimeLimit, TheErrorThatIsSaidIsThatOfThePicture) {
    ASSERT_EQ(rendered(other, {"--samples", "512"}).code, 0);
    const std::string reference = other / "picture.exr", csv = folder / "error.csv";
    const auto run = ended(folder, {"--reference", reference, "--csv", csv, "--threads", "2"});
    const auto last = lines_of(bytes_of(csv)).back();
    EXPECT_TRUE(last.starts_with(samples_of(run) + ",")) << last;
    Process compare({program("lightnet"), "compare", reference, folder / "picture.exr", "--json"});
    ASSERT_EQ(compare.wait(), 0) << compare.output();
    const double relmse = number_after(compare.output(), "relmse");
    EXPECT_NEAR(number_after(run.report.substr(run.report.find("\"error\":")), "relmse"), relmse, 1e-3 * relmse);
    EXPECT_THAT(run.said, HasSubstr("relMSE to " + reference));
}

TEST_F(TimeLimit, ACurveWantsAReferenceOfItsSize) {
    ASSERT_EQ(launch(graph_file("cornell.lua"), other, {"--samples", "1", "--size", "8x8"}).code, 0);
    const auto wrong = rendered(folder, {"--samples", "1", "--reference", other / "picture.exr"});
    EXPECT_EQ(wrong.code, 2);
    EXPECT_THAT(wrong.said, HasSubstr("is of 8x8 pixels, and the picture of 48x36"));
    EXPECT_EQ(rendered(folder, {"--csv", folder / "x.csv"}).code, 2) << "of what?";
    const auto mine = folder.write("mine.csv", "my figures");
    ASSERT_EQ(rendered(other, {"--samples", "1"}).code, 0);
    EXPECT_EQ(rendered(folder, {"--samples", "1", "--reference", other / "picture.exr", "--csv", mine}).code, 2);
    EXPECT_EQ(bytes_of(mine), "my figures");
}

}  // namespace
}  // namespace lightnet::test
