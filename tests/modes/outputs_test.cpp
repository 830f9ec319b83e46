// What runs leave on disks: nothing of others is lost, and no finished picture either.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>

#include "tests/modes/daemons.hpp"

namespace lightnet::test {
namespace {

namespace fs = std::filesystem;
using std::chrono::seconds;
using testing::HasSubstr;

using Words = std::vector<std::string>;

class Outputs : public ::testing::Test {
protected:
    std::string keeping_graph(const std::string& keep) const {
        for (const char* scene : {"glass_ball.pbrt", "cornell_box.pbrt"})
            folder.write(std::string("graphs/") + scene, bytes_of(graph_file(scene)));
        auto text = bytes_of(graph_file("paper/figure5.lua"));
        text.insert(text.find("rays = rays") + 11, ", keep = '" + keep + "'");
        text.replace(text.find("../glass"), 3, "");
        return folder.write("graphs/keeps.lua", text);
    }
    const Words small{"--size", "16x16", "--samples", "1"};
    const Folder folder;
};

TEST_F(Outputs, OfAGraphStayInItsFolder) {
    const auto mine = folder.write("home/.bashrc", "alias ll='ls -l'");
    auto words = small;
    words.insert(words.end(), {"-D", "photons=1000", "-D", "rays=16", "--cache", "none"});
    const auto out = launch(keeping_graph("../home/.bashrc"), folder, words);
    EXPECT_EQ(out.code, 2);
    EXPECT_THAT(out.said, HasSubstr("home/.bashrc' is outside of the graph's folder"));
    folder.write("graphs/notes", "mine");
    const auto in_place = launch(keeping_graph("notes"), folder, words);
    EXPECT_EQ(in_place.code, 2);
    EXPECT_THAT(in_place.said, HasSubstr("notes' is there already, and is nothing that lightnet has written"));
    EXPECT_EQ(bytes_of(mine), "alias ll='ls -l'");
    EXPECT_EQ(bytes_of(folder / "graphs" / "notes"), "mine");
}

TEST_F(Outputs, TakeThePlaceOfNoFileOfOthers) {
    for (const std::string name : {"picture.exr", "picture.png", "picture.run.json", "picture.exr.checkpoint"}) {
        const auto mine = folder.write(name, "my notes");
        const auto refused = launch(graph_file("direct.lua"), folder, small);
        EXPECT_EQ(refused.code, 2) << refused.said;
        EXPECT_THAT(refused.said, HasSubstr(name + ": is there already, and is nothing that lightnet has written"));
        EXPECT_EQ(bytes_of(mine), "my notes");
        fs::remove(mine);
    }
    folder.write("run.json", "my notes");
    EXPECT_EQ(launch(graph_file("direct.lua"), folder, small).code, 0);
    EXPECT_EQ(launch(graph_file("direct.lua"), folder, small).code, 0) << "its own picture may be replaced";
    EXPECT_EQ(bytes_of(folder / "run.json"), "my notes");
}

TEST_F(Outputs, TakeThePlaceOfNothingThatTheSceneReads) {
    const auto wood = bytes_of(graph_file("../docs/watch.png"));
    folder.write("picture.png", wood);
    folder.write("plate.mtl", "newmtl wood\nmap_Kd picture.png\n");
    folder.write("plate.obj", "mtllib plate.mtl\nusemtl wood\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n");
    const auto graph = folder.write("plate.lua",
                                    "scene = Scene { 'plate.obj' }\n"
                                    "direct = DirectLighting { samples = 1 }\n"
                                    "image = RayTracer { direct, scene = scene }\n");
    const auto refused = launch(graph, folder, small);
    EXPECT_EQ(refused.code, 2) << refused.said;
    EXPECT_THAT(refused.said, HasSubstr("picture.png: is what this picture is made of, and would be lost"));
    EXPECT_EQ(bytes_of(folder / "picture.png"), wood);
}

TEST_F(Outputs, OfTwoPicturesInAFolderHaveReportsOfTheirOwn) {
    for (const std::string name : {"one", "two"}) {
        Process run(launch_words(graph_file("direct.lua"), folder / (name + ".exr"), small));
        EXPECT_EQ(run.wait(), 0) << run.output();
    }
    for (const std::string name : {"one", "two"})
        EXPECT_THAT(bytes_of(folder / (name + ".run.json")), HasSubstr(name + ".exr\""));
}

TEST_F(Outputs, LackingAReportThatWasAskedForAreAFailure) {
    fs::create_directory(folder / "pages");
    Process run(launch_words(graph_file("cornell.lua"), folder / "picture.exr",
                             {"--size", "64x64", "--samples", std::to_string(256 / slowdown), "--progress", "json",
                              "--report", folder / "pages" / "report.html"}));
    ASSERT_TRUE(run.wait_for("\"event\":\"progress\"")) << run.output();
    fs::remove_all(folder / "pages");
    EXPECT_EQ(run.wait(), 1) << run.output();
    EXPECT_THAT(run.output(), HasSubstr("there is no report: "));
    EXPECT_THAT(bytes_of(folder / "picture.run.json"), HasSubstr("\"outcome\": \"done\"")) << "the picture is good";
}

TEST_F(Outputs, AreOfOneRunAtATime) {
    const Words long_run{"--size", "64x64", "--samples", "100000", "--progress", "json"};
    Process first(launch_words(graph_file("cornell.lua"), folder / "picture.exr", long_run));
    ASSERT_TRUE(first.wait_for("\"event\":\"progress\"")) << first.output();
    const auto second = launch(graph_file("cornell.lua"), folder, small);
    EXPECT_EQ(second.code, 2);
    EXPECT_THAT(second.said, HasSubstr("another run is writing this picture (process " + std::to_string(first.id())));
    first.signal(SIGKILL);
    first.wait();
    const auto third = launch(graph_file("cornell.lua"), folder, small);
    EXPECT_EQ(third.code, 0) << third.said;
}

/// A run into a folder that is taken away while it renders.
class Gone : public Outputs {
protected:
    Gone() {
        fs::create_directory(folder / "out");
        fs::create_directory(folder / "tmp");
        if (const char* value = std::getenv("TMPDIR")) before = value;
        ::setenv("TMPDIR", (folder / "tmp").c_str(), 1);
        const auto samples = std::to_string(256 / slowdown);
        run = std::make_unique<Process>(
            launch_words(graph_file("cornell.lua"), picture,
                         {"--size", "64x64", "--samples", samples, "--wait", "2", "--progress", "json"}));
        ::unsetenv("TMPDIR");
        if (!before.empty()) ::setenv("TMPDIR", before.c_str(), 1);
        EXPECT_TRUE(run->wait_for("\"event\":\"progress\"")) << run->output();
        fs::remove_all(folder / "out");
    }
    std::string before;
    fs::path picture = folder / "out" / "picture.exr";
    std::unique_ptr<Process> run;
};

TEST_F(Gone, LosesNoPictureButPutsItElsewhere) {
    EXPECT_EQ(run->wait(), 1) << run->output();
    EXPECT_THAT(run->output(), HasSubstr("trying again for 2 s"));
    ASSERT_THAT(run->output(), HasSubstr("it is in " + (folder / "tmp" / "lightnet-").string()));
    const auto at = run->output().find("it is in ") + 9;
    const auto there = fs::path(run->output().substr(at, run->output().find("picture.exr", at) - at));
    EXPECT_THAT(bytes_of(there / "picture.exr"), testing::StartsWith("\x76\x2f\x31\x01"));
    EXPECT_THAT(bytes_of(there / "picture.run.json"), HasSubstr("\"outcome\": \"failed\""));
    EXPECT_TRUE(fs::exists(there / "picture.png"));
}

TEST_F(Outputs, AreNeverElsewhereWithoutAWord) {
    fs::create_directory(folder / "tmp");
    for (const std::string mode : {"none", "plain", "bar"}) {
        fs::create_directory(folder / "out");
        const auto words = launch_words(
            graph_file("cornell.lua"), folder / "out" / "picture.exr",
            {"--size", "48x48", "--samples", std::to_string(128 / slowdown), "--wait", "1", "--progress", mode});
        Words with_tmp{"/usr/bin/env", "TMPDIR=" + (folder / "tmp").string()};
        with_tmp.insert(with_tmp.end(), words.begin(), words.end());
        Process run(with_tmp);
        while (!fs::exists(folder / "out" / ".picture.exr.lock") && run.wait(std::chrono::milliseconds(10)) < 0)
            continue;
        fs::remove_all(folder / "out");
        EXPECT_EQ(run.wait(), 1) << mode;
        EXPECT_THAT(run.output(), HasSubstr("lightnet: the picture can't be written: ")) << mode;
        EXPECT_THAT(run.output(), HasSubstr("it is in " + (folder / "tmp" / "lightnet-").string())) << mode;
    }
}

TEST_F(Gone, WritesThePictureWhereItBelongsWhenTheFolderComesBack) {
    ASSERT_TRUE(run->wait_for("trying again for 2 s")) << run->output();
    fs::create_directory(folder / "out");
    EXPECT_EQ(run->wait(), 0) << run->output();
    EXPECT_TRUE(fs::exists(picture));
    EXPECT_THAT(run->output(), testing::Not(HasSubstr("it is in ")));
}

TEST_F(Outputs, OfADaemonLieInNoFolderOfOthers) {
    const auto mine = folder.write("papers/thesis.tex", "text");
    Process daemon({program("lightnetd"), "--listen", "tcp://127.0.0.1:*", "--cache", folder / "papers"});
    EXPECT_EQ(daemon.wait(), 1);
    EXPECT_THAT(daemon.output(), HasSubstr("is no cache of lightnet's: it holds 'thesis.tex'"));
    EXPECT_EQ(bytes_of(mine), "text");
}

}  // namespace
}  // namespace lightnet::test
