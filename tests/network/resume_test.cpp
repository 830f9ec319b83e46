// Runs that end before their picture is whole, and go on later.
#include <gtest/gtest.h>

#include <csignal>

#include "tests/network/daemons.hpp"

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
        EXPECT_EQ(run.wait(slowdown * seconds(10)), 130);
        EXPECT_NE(run.output().find("--resume goes on"), std::string::npos) << run.output();
        ASSERT_TRUE(std::filesystem::exists(kept));
    }
    const auto resumed = go_on({"--resume", "--local-workers", "1"});
    EXPECT_EQ(resumed.code, 0) << resumed.said;
    EXPECT_NE(resumed.said.find("going on from"), std::string::npos) << resumed.said;
    EXPECT_FALSE(std::filesystem::exists(kept)) << "it is of no use any more";
    EXPECT_TRUE(resumed.picture == reference());
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
        EXPECT_EQ(run.wait(slowdown * seconds(10)), 130);
    }
    Process run(words({"--threads", "2", "--resume", "--seed", "9"}));
    EXPECT_EQ(run.wait(slowdown * seconds(10)), 2);
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
