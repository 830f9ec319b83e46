// Local workers that are given troubles, and what becomes of the picture: nothing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/modes/daemons.hpp"

namespace lightnet::test {
namespace {

using ::testing::HasSubstr;

const std::vector<std::string> picture{"--size", "64x64", "--samples", "16", "--tile", "16", "--cache", "none"};

Launch launch_with(const std::vector<std::string>& more) {
    const Folder folder;
    auto words = picture;
    words.insert(words.end(), more.begin(), more.end());
    return launch(graph_file("paper/figure5.lua"), folder, words);
}

TEST(FaultInjection, OfLocalWorkersLeaveThePictureAsItIs) {
    const auto serial = launch_with({"--threads", "1"});
    ASSERT_EQ(serial.code, 0) << serial.said;
    const auto troubled = launch_with({"--local-workers", "3", "--delay", "3", "--slow", "worker1=3", "--lose",
                                       "worker2@20%", "--lose", "worker3@50%"});
    ASSERT_EQ(troubled.code, 0) << troubled.said;
    EXPECT_THAT(troubled.said, HasSubstr("worker2 (tcp://127.0.0.1:"));
    EXPECT_THAT(troubled.said, HasSubstr("is killed now, as --lose says"));
    EXPECT_THAT(troubled.said, HasSubstr("has died; it is started anew"));
    EXPECT_TRUE(troubled.picture == serial.picture);
}

TEST(BenchHosts, PrintsHowMuchQuickerMoreWorkersAre) {
    const Folder folder;
    Process bench({program("lightnet"), "bench-hosts", graph_file("cornell.lua"), "--size", "48x48", "--samples", "16",
                   "--local-workers", "3", "--rounds", "2", "--csv", folder / "figures.csv"});
    ASSERT_EQ(bench.wait(), 0) << bench.output();
    EXPECT_THAT(bench.output(), ::testing::ContainsRegex("\n +1 +[0-9.]+ s +[0-9.]+ s +[0-9.]+ s +1.00 +100 %"));
    EXPECT_THAT(bench.output(), ::testing::ContainsRegex("\n +2 .*\n +3 "));
    EXPECT_THAT(bench.output(), HasSubstr("all pictures have the same bytes"));
    const auto csv = bytes_of(folder / "figures.csv");
    EXPECT_THAT(csv, ::testing::StartsWith("hosts,round,prepare_seconds,render_seconds\n1,1,"));
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 7);
}

TEST(BenchHosts, WantsHostsOfWhichAnyWillDo) {
    const Folder folder;
    folder.write("hosts.lua",
                 "place 'tcp://127.0.0.1:7777' { image = 1 }\nplace 'tcp://127.0.0.1:7778' { direct = 1, "
                 "bounce = 1, lighting = 1 }\n");
    folder.write("mine.csv", "a,b\n");
    const auto said = [&](std::vector<std::string> words) {
        words.insert(words.begin(), {program("lightnet"), "bench-hosts", graph_file("cornell.lua")});
        Process bench(words);
        EXPECT_NE(bench.wait(), 0);
        return bench.output();
    };
    EXPECT_THAT(said({"--hosts", folder / "hosts.lua"}), HasSubstr("wants hosts that hold the whole network"));
    EXPECT_THAT(said({"--csv", folder / "mine.csv"}), HasSubstr("mine.csv"));
    EXPECT_EQ(bytes_of(folder / "mine.csv"), "a,b\n");
}

}  // namespace
}  // namespace lightnet::test
