// Daemons that a real Slurm starts, loses, starts anew and is rid of again.
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>

#include "tests/modes/daemons.hpp"
#include "transport/keys/key_file.hpp"

namespace lightnet::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using Clock = std::chrono::steady_clock;

class Slurm : public ::testing::Test {
protected:
    static void SetUpTestSuite() {
        lab = new Folder;
        Process up({script, "up", lab->path().string(), "2"});
        there = up.wait(seconds(60)) == 0;
        why = up.output();
        ::setenv("SLURM_CONF", (*lab / "slurm.conf").c_str(), 1);
    }
    static void TearDownTestSuite() {
        Process({script, "down", lab->path().string()}).wait(seconds(30));
        delete lab;
    }
    void SetUp() override {
        if (!there) GTEST_SKIP() << "no Slurm can be started here: " << why;
    }

    std::unique_ptr<Process> start(const std::string& samples, const std::vector<std::string>& more) {
        std::vector<std::string> words{"--size",
                                       "64x64",
                                       "--samples",
                                       samples,
                                       "--tile",
                                       "16",
                                       "--progress",
                                       "json",
                                       "--partition=main",
                                       "--slurm-args",
                                       "--output=" + (folder / "element-%a.out").string()};
        words.insert(words.end(), more.begin(), more.end());
        return std::make_unique<Process>(launch_words(graph_file("cornell.lua"), out, words));
    }
    std::string reference(const std::string& samples) {
        const Folder other;
        return launch(graph_file("cornell.lua"), other, {"--size", "64x64", "--samples", samples, "--threads", "2"})
            .picture;
    }
    // Jobs that are waiting or running.
    static std::string jobs() {
        Process queue({"/usr/bin/squeue", "-h", "-o", "%i %T %N"});
        queue.wait(seconds(10));
        return queue.output();
    }
    static bool no_jobs_within(seconds most) {
        for (const auto end = Clock::now() + most; Clock::now() < end;)
            if (jobs().find("RUNNING") == std::string::npos && jobs().find("PENDING") == std::string::npos) return true;
        return false;
    }
    void expect_same(Process& run, const std::string& samples) {
        const auto end = finish(run, out);
        EXPECT_EQ(end.code, 0) << end.said;
        EXPECT_TRUE(end.picture == reference(samples)) << end.said;
        EXPECT_TRUE(no_jobs_within(seconds(10))) << jobs();
    }
    static void lab_does(const std::string& what, const std::string& node) {
        Process does({script, what, lab->path().string(), node});
        EXPECT_EQ(does.wait(seconds(20)), 0) << does.output();
    }

    static inline const std::string script = LIGHTNET_SOURCE_DIR "/tests/modes/slurm_lab.sh";
    static inline Folder* lab = nullptr;
    static inline bool there = false;
    static inline std::string why;
    Folder folder;
    std::filesystem::path out = folder / "picture.exr";
};

TEST_F(Slurm, StartsDaemonsAndIsRidOfThemAtTheEnd) {
    const auto run = start("64", {"--slurm", "2"});
    expect_same(*run, "64");
    EXPECT_NE(run->output().find("Slurm has taken job"), std::string::npos) << run->output();
}

TEST_F(Slurm, SpoolsNoSecretAndLeavesNone) {
    const auto run = start("64", {"--slurm", "2"});
    ASSERT_TRUE(run->wait_for("Slurm has taken job")) << run->output();
    Process spooled({"/usr/bin/grep", "-rl", "secret-", (*lab / "state").string(), (*lab / "spool").string()});
    EXPECT_EQ(spooled.wait(seconds(10)), 1) << spooled.output();
    EXPECT_TRUE(processes_with("secret-").empty());
    expect_same(*run, "64");
    for (const auto& file : std::filesystem::directory_iterator(std::filesystem::path(usual_key_file()).parent_path()))
        EXPECT_NE(file.path().filename().string().substr(0, 6), "slurm-") << file.path();
}

TEST_F(Slurm, IsRidOfThemAfterAnInterruptToo) {
    const auto run = start("4096", {"--slurm", "2"});
    ASSERT_TRUE(run->wait_for("\"event\":\"progress\"", seconds(30))) << run->output();
    run->signal(SIGINT);
    EXPECT_EQ(run->wait(seconds(10)), 130) << run->output();
    EXPECT_TRUE(no_jobs_within(seconds(10))) << jobs();
}

TEST_F(Slurm, SaysWhatSbatchSaysWhenItDoesNotTakeTheJob) {
    Process run(launch_words(graph_file("cornell.lua"), out, {"--slurm", "1", "--partition", "nowhere"}));
    EXPECT_EQ(run.wait(seconds(20)), 1);
    EXPECT_NE(run.output().find("invalid partition"), std::string::npos) << run.output();
}

TEST_F(Slurm, GrowsWithItsNodes) {
    const auto run = start("512", {"--slurm", "4"});
    ASSERT_TRUE(run->wait_for("-2 is ready", seconds(30))) << run->output();
    const auto begun = Clock::now();
    lab_does("node", "s3");
    lab_does("node", "s4");
    ASSERT_TRUE(run->wait_for("-4 is ready", seconds(30))) << run->output() << jobs();
    RecordProperty("seconds_to_grow", std::to_string(std::chrono::duration<double>(Clock::now() - begun).count()));
    expect_same(*run, "512");
}

TEST_F(Slurm, StartsAnewWhatANodeHasLost) {
    const auto run = start("1024", {"--slurm", "2"});
    ASSERT_TRUE(run->wait_for("-2 is ready", seconds(30)) && run->wait_for("\"event\":\"progress\"")) << run->output();
    lab_does("lose", "s2");
    ASSERT_TRUE(run->wait_for("is lost", seconds(20))) << run->output() << jobs();
    expect_same(*run, "1024");
}

TEST_F(Slurm, RunsTheScriptThatPeopleRead) {
    const auto farm = load_or_make_key(folder.file("farm")), user = load_or_make_key(folder.file("user"));
    folder.write("farm.keys", farm.open.text() + " slurm-*\n");
    Process run(launch_words(graph_file("cornell.lua"), out,
                             {"--size", "64x64", "--samples", "64", "--listen", "tcp://127.0.0.1:*", "--key",
                              folder.file("user"), "--allow", folder.file("farm.keys")}));
    const auto launcher = join_endpoint(run);
    Process submit({"/usr/bin/sbatch", "--output=/dev/null", "--array=1-2",
                    "--export=ALL,LIGHTNET_FARM_KEY=" + folder.file("farm"),
                    LIGHTNET_SOURCE_DIR "/packaging/slurm/lightnet.sbatch", launcher, user.open.text(),
                    program("lightnetd")});
    EXPECT_EQ(submit.wait(seconds(20)), 0) << submit.output();
    const auto end = finish(run, out);
    EXPECT_EQ(end.code, 0) << end.said;
    Process({"/usr/bin/scancel", "--user=root"}).wait(seconds(10));
}

}  // namespace
}  // namespace lightnet::test
