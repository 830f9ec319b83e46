// Hosts that dial out and let nobody in: all that they ask and answer goes over the one connection that they opened.
#include <gtest/gtest.h>

#include <csignal>

#include "tests/modes/daemons.hpp"

namespace lightnet::test {
namespace {

using std::chrono::seconds;

class Join : public ::testing::Test {
protected:
    static void SetUpTestSuite() {
        const Folder folder;
        auto alone = size;
        alone.insert(alone.end(), {"--threads", "1"});
        reference = new std::string(launch(graph_file("cornell.lua"), folder, alone).picture);
        ASSERT_FALSE(reference->empty());
    }
    static void TearDownTestSuite() { delete reference; }

    std::unique_ptr<Process> start(const std::string& hosts, std::vector<std::string> more = {},
                                   const std::string& listen = "tcp://127.0.0.1:*") {
        auto words = size;
        words.insert(words.end(), {"--listen", listen});
        if (!hosts.empty()) words.insert(words.end(), {"--hosts", folder.write("hosts.lua", hosts)});
        words.insert(words.end(), more.begin(), more.end());
        return std::make_unique<Process>(launch_words(graph_file("cornell.lua"), out, words));
    }
    Launch expect_same(Process& run) {
        auto end = finish(run, out);
        EXPECT_EQ(end.code, 0) << end.said;
        EXPECT_TRUE(end.picture == *reference) << "the bytes differ\n" << end.said;
        return end;
    }

    static inline const std::vector<std::string> size{"--size",     "48x48", "--samples", "32",
                                                      "--progress", "json",  "--tile",    "16"};
    static inline std::string* reference = nullptr;
    Folder folder;
    std::filesystem::path out = folder / "picture.exr";
};

TEST_F(Join, NeedsNoPortThatIsOpen) {
    const auto run = start("");
    const auto inside = joining_daemon(folder, join_endpoint(*run), "inside");
    const auto end = expect_same(*run);
    EXPECT_NE(end.said.find("inside is ready"), std::string::npos) << end.said;
    EXPECT_NE(end.report.find("\"machine\": "), std::string::npos) << "machine facts stand in the report";
}

TEST_F(Join, OfTwoThatCannotReachEachOtherIsRelayed) {
    const auto run = start("place 'left' { image = 1, lighting = 1 }\nplace 'right' { direct = 1, bounce = 1 }");
    const auto launcher = join_endpoint(*run);
    const auto left = joining_daemon(folder, launcher, "left"), right = joining_daemon(folder, launcher, "right");
    const auto end = expect_same(*run);
    EXPECT_GT(counter(end.report, "relayed_bytes"), 0);
    EXPECT_EQ(counter(end.report, "broken_packets"), 0);
}

TEST_F(Join, MixesWithHostsThatAreCalledWithLocalWorkersAndWithThreads) {
    const Daemon called(folder);
    const auto run = start("place '" + called.endpoint + "' { bounce = 1 }\nplace 'inside' { direct = 1, image = 1 }",
                           {"--local-workers", "1", "--threads", "1"});
    const auto inside = joining_daemon(folder, join_endpoint(*run), "inside");
    const auto end = expect_same(*run);
    for (const auto* who : {"inside is ready", "places of this process are ready"})
        EXPECT_NE(end.said.find(who), std::string::npos) << who << "\n" << end.said;
}

TEST_F(Join, OfOneNameTwiceMakesTwoHosts) {
    const auto run = start("place 'twin' { image = 1 }\nplace 'twin-2' { bounce = 1, direct = 1 }");
    const auto launcher = join_endpoint(*run);
    const auto one = joining_daemon(folder, launcher, "twin"), two = joining_daemon(folder, launcher, "twin");
    const auto end = expect_same(*run);
    EXPECT_NE(end.said.find("twin-2 is ready"), std::string::npos) << end.said;
}

TEST_F(Join, OutlivesTheLauncherAndServesTheNext) {
    auto first = start("");
    const auto launcher = join_endpoint(*first);
    const auto inside = joining_daemon(folder, launcher, "inside");
    expect_same(*first);
    first = start("", {}, launcher);
    expect_same(*first);
    inside->signal(SIGTERM);
    EXPECT_EQ(inside->wait(), 0) << inside->output();
}

TEST_F(Join, IsTakenBackWhenNobodyNeedsIt) {
    const auto idle = joining_daemon(folder, "tcp://127.0.0.1:1", "idle", {"--leave-after", "1"});
    EXPECT_EQ(idle->wait(), 0) << idle->output();
    EXPECT_NE(idle->output().find("nobody needs it"), std::string::npos) << idle->output();
}

TEST_F(Join, UnderASingleNameWaitsForTheOneBefore) {
    const auto name = "test-" + std::to_string(getpid());
    const auto one = joining_daemon(folder, "tcp://127.0.0.1:1", "one", {"--single", name});
    ASSERT_TRUE(one->wait_for("joining"));
    const auto two = joining_daemon(folder, "tcp://127.0.0.1:1", "two", {"--single", name});
    EXPECT_FALSE(two->wait_for("joining", std::chrono::milliseconds(400)));
    one->signal(SIGKILL);
    EXPECT_TRUE(two->wait_for("joining")) << two->output();
}

}  // namespace
}  // namespace lightnet::test
