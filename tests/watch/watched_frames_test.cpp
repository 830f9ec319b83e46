// One page for all frames of a sequence.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/modes/daemons.hpp"
#include "tests/watch/visitor.hpp"

namespace lightnet::watched_frames_test {
namespace {

TEST(WatchedFrames, AreShownOneAfterTheOtherOnOnePage) {
    const test::Folder folder;
    test::Process run({test::program("lightnet"), "run", test::graph_file("film.lua"), "--frames", "1-3", "-o",
                       folder.file("f.####.exr"), "--size", "64x64", "--samples", "96", "--threads", "1", "--cache",
                       "none", "--watch"});
    const std::string before = "http://127.0.0.1:";
    ASSERT_TRUE(run.wait_for(before) && run.wait_for("\n")) << run.output();
    const auto port =
        static_cast<std::uint16_t>(std::atoi(run.output().c_str() + run.output().find(before) + before.size()));
    test::Visitor page(port);
    ASSERT_TRUE(page.watch("127.0.0.1:" + std::to_string(port)));
    nlohmann::json frames;
    for (int at_work = 0; at_work < 3;) {
        const auto text = page.next_with("\"frames\"");
        ASSERT_TRUE(text) << run.output();
        const auto hello = nlohmann::json::parse(*text)["hello"];
        frames = hello["frames"];
        EXPECT_GE(frames["at_work"], at_work) << "they go upwards";
        EXPECT_EQ(hello["edited"], false) << "nobody edits them";
        at_work = frames["at_work"];
    }
    EXPECT_EQ(frames["all"], nlohmann::json::parse(R"([[1,"done"],[2,"done"],[3,""]])"));
    EXPECT_EQ(run.wait(), 0) << run.output();
    EXPECT_EQ(run.output().find("watch it at"), run.output().rfind("watch it at")) << "one address for all";
}

}  // namespace
}  // namespace lightnet::watched_frames_test
