// Runs that end before their picture is whole, and go on later.
#include <gtest/gtest.h>

#include <csignal>

#include "tests/modes/daemons.hpp"

namespace lightnet::test {
namespace {

using std::chrono::seconds;

class Resume : public ::testing::Test {
protected:
    std::vector<std::string> words(std::vector<std::string> more) const {
        std::vector<std::string> all{"--size",     "64x64", "--samples",    std::to_string(768 / slowdown),
                                     "--tile",     "16",    "--checkpoint", "1",
                                     "--progress", "json"};
        all.insert(all.end(), more.begin(), more.end());
        return launch_words(graph_file("cornell.lua"), out, all);
    }
    std::string reference() {
        Process run(words({"--threads", "2"}));
        return finish(run, out).picture;
    }
    Launch go_on(const std::vector<std::string>& more) {
        Process run(words(more));
        return finish(run, out);
    }
    Folder folder;
    std::filesystem::path out = folder / "picture.exr";
    std::filesystem::path kept = folder / "picture.exr.checkpoint";
};

TEST_F(Resume, GivesTheSameBytesAfterAnInterruptInAnyMode) {
    {
        Process run(words({"--threads", "2"}));
        ASSERT_TRUE(run.wait_for("\"event\":\"progress\"")) << run.output();
        run.signal(SIGINT);
        EXPECT_EQ(run.wait(), 130);
        EXPECT_NE(run.output().find("cancelled: "), std::string::npos) << run.output();
        EXPECT_NE(run.output().find("; --resume goes on from here"), std::string::npos) << run.output();
        ASSERT_TRUE(std::filesystem::exists(kept));
        EXPECT_EQ(bytes_of(out).substr(0, 4), "v/1\x01") << "what there is, as an EXR";
    }
    const auto resumed = go_on({"--resume", "--local-workers", "1"});
    EXPECT_EQ(resumed.code, 0) << resumed.said;
    EXPECT_NE(resumed.said.find("going on from"), std::string::npos) << resumed.said;
    EXPECT_TRUE(resumed.picture == reference());
}

// 100 samples end in the middle of a block of 16, and of a group of blocks.
TEST_F(Resume, AddsSamplesToAFinishedPictureWithTheBytesOfAllAtOnce) {
    const std::vector<std::string> small{"--size", "40x40", "--progress", "plain"};
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.end(), small.begin(), small.end());
        return launch(graph_file("cornell.lua"), folder, more);
    };
    for (const std::string samples : {"20", "100", "160", "176"}) {
        const auto more = with({"--samples", samples, "--resume", "--threads", "2"});
        ASSERT_EQ(more.code, 0) << more.said;
        const Folder elsewhere;
        Process at_once(launch_words(graph_file("cornell.lua"), elsewhere / "picture.exr",
                                     {"--size", "40x40", "--samples", samples, "--tile", "32"}));
        EXPECT_TRUE(finish(at_once, elsewhere / "picture.exr").picture == more.picture) << samples;
    }
}

TEST_F(Resume, SaysThatAPictureIsFinishedAndLeavesIt) {
    const std::vector<std::string> small{"--size", "16x16", "--samples", "20"};
    const auto first = launch(graph_file("cornell.lua"), folder, small);
    ASSERT_EQ(first.code, 0) << first.said;
    const auto written = std::filesystem::last_write_time(out);
    auto again = small;
    again.push_back("--resume");
    const auto second = launch(graph_file("cornell.lua"), folder, again);
    EXPECT_EQ(second.code, 0);
    EXPECT_NE(second.said.find("is finished: nothing to do; ask for more with --samples"), std::string::npos)
        << second.said;
    EXPECT_EQ(std::filesystem::last_write_time(out), written);
    EXPECT_TRUE(second.report == first.report);

    std::filesystem::remove(out);
    EXPECT_TRUE(launch(graph_file("cornell.lua"), folder, again).picture == first.picture) << "its file was lost";
    again[3] = "10";
    const auto fewer = launch(graph_file("cornell.lua"), folder, again);
    EXPECT_EQ(fewer.code, 2);
    EXPECT_NE(fewer.said.find("is of 20 samples per pixel, and only 10 are asked for"), std::string::npos)
        << fewer.said;
}

TEST_F(Resume, NamesAllThatMakesAnotherPicture) {
    const auto graph = graph_file("cornell.lua");
    ASSERT_EQ(launch(graph, folder, {"--size", "16x16", "--samples", "4"}).code, 0);
    const auto said = [&](const std::string& of, std::vector<std::string> words) {
        words.insert(words.end(), {"--samples", "4", "--resume"});
        const auto refused = launch(of, folder, words);
        EXPECT_EQ(refused.code, 2);
        return refused.said;
    };
    EXPECT_NE(said(graph, {"--size", "8x8"})
                  .find("another picture (crop 0,0,16,16 there, 0,0,8,8 here; size 16x16 "
                        "there, 8x8 here)"),
              std::string::npos);
    EXPECT_NE(said(graph_file("direct.lua"), {"--size", "16x16"}).find("another picture (graph)"), std::string::npos);
    EXPECT_NE(said(graph, {"--size", "16x16", "--crop", "1,2,9,8"}).find("(crop 0,0,16,16 there, 1,2,9,8 here)"),
              std::string::npos);
}

TEST_F(Resume, IsOverWhenThePictureIsToBeForgotten) {
    const std::vector<std::string> small{"--size", "16x16", "--samples", "20", "--forget"};
    ASSERT_EQ(launch(graph_file("cornell.lua"), folder, small).code, 0);
    EXPECT_FALSE(std::filesystem::exists(kept));
}

// Slurm warns by SIGUSR1, and ends by another signal when the time is over: that one is no impatient second.
TEST_F(Resume, IsPossibleAfterAWarning) {
    Process run(words({"--threads", "2"}));
    ASSERT_TRUE(run.wait_for("\"event\":\"progress\"")) << run.output();
    run.signal(SIGUSR1);
    run.signal(SIGTERM);
    EXPECT_EQ(run.wait(), 130) << run.output();
    EXPECT_NE(run.output().find("cancelled: "), std::string::npos) << run.output();
    EXPECT_TRUE(std::filesystem::exists(kept));
}

// As in the background jobs of a script.
TEST_F(Resume, IsNotNeededAfterASignalThatIsIgnored) {
    for (const auto& [name, number] :
         {std::pair("INT", SIGINT), std::pair("USR1", SIGUSR1), std::pair("HUP", SIGHUP)}) {
        auto all = words({"--threads", "2"});
        all.insert(all.begin(), {"/bin/sh", "-c", std::string("trap '' ") + name + "; exec \"$@\"", "sh"});
        Process run(all);
        ASSERT_TRUE(run.wait_for("\"event\":\"progress\"")) << run.output();
        run.signal(number);
        run.signal(SIGTERM);
        EXPECT_EQ(run.wait(), 130) << run.output();
        EXPECT_NE(run.output().find("cancelled: "), std::string::npos) << "SIGTERM was the first: " << run.output();
    }
}

TEST_F(Resume, IsPossibleAfterTheTerminalWasClosed) {
    Process run(words({"--threads", "2"}));
    ASSERT_TRUE(run.wait_for("\"event\":\"progress\"")) << run.output();
    run.signal(SIGHUP);
    run.signal(SIGHUP);  // a shell and the system both send it
    EXPECT_EQ(run.wait(), 130) << run.output();
    EXPECT_TRUE(std::filesystem::exists(kept));
}

TEST_F(Resume, GivesTheSameBytesAfterTheLauncherWasKilled) {
    {
        Process run(words({"--threads", "1"}));
        const auto end = std::chrono::steady_clock::now() + slowdown * seconds(20);
        while (!std::filesystem::exists(kept) && std::chrono::steady_clock::now() < end)
            run.wait_for("never said", std::chrono::milliseconds(20));
        run.signal(SIGKILL);
        EXPECT_EQ(run.wait(), 128 + SIGKILL) << "it should not have finished";
    }
    ASSERT_TRUE(std::filesystem::exists(kept));
    const auto resumed = go_on({"--resume", "--threads", "2"});
    EXPECT_EQ(resumed.code, 0) << resumed.said;
    EXPECT_TRUE(resumed.picture == reference());
}

TEST_F(Resume, RefusesTheCheckpointOfAnotherPictureAndSaysWhy) {
    {
        Process run(words({"--threads", "2"}));
        ASSERT_TRUE(run.wait_for("\"event\":\"progress\"")) << run.output();
        run.signal(SIGINT);
        EXPECT_EQ(run.wait(), 130);
    }
    Process run(words({"--threads", "2", "--resume", "--seed", "9"}));
    EXPECT_EQ(run.wait(), 2);
    EXPECT_NE(run.output().find("another picture (seed 0 there, 9 here)"), std::string::npos) << run.output();
}

TEST_F(Resume, KeepsWhatThereIsWhenTheLastHostIsLost) {
    const Daemon only(folder);
    const auto hosts = folder.write("hosts.lua", "place '" + only.endpoint + "' {}");
    Process run(words({"--hosts", hosts, "--wait", "1"}));
    ASSERT_TRUE(run.wait_for("\"event\":\"progress\"")) << run.output();
    only.process->signal(SIGKILL);
    EXPECT_EQ(run.wait(slowdown * seconds(20)), 1) << run.output();
    EXPECT_NE(run.output().find("'image' has no place any more; waiting 1 s"), std::string::npos) << run.output();
    EXPECT_TRUE(std::filesystem::exists(kept));
}

}  // namespace
}  // namespace lightnet::test
