// Runs that are shown in a viewer: the same picture in both.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/modes/daemons.hpp"
#include "tests/watch/tev_viewer.hpp"

namespace lightnet::tev_run_test {
namespace {

using test::Folder;
using test::graph_file;
using test::Process;
using test::TevViewer;
using testing::HasSubstr;
using testing::IsEmpty;

class TevModes : public testing::TestWithParam<std::vector<std::string>> {};

TEST_P(TevModes, ShowTheBytesOfThePicture) {
    const Folder folder;
    TevViewer viewer;
    auto words = GetParam();
    words.insert(words.end(), {"--size", "96x96", "--samples", "64", "--cache", folder / "cache"});
    const auto plain = test::launch(graph_file("cornell.lua"), folder, words);
    ASSERT_EQ(plain.code, 0) << plain.said;
    const auto picture = folder / "shown.exr";
    words.insert(words.end(), {"--preview", "tev:" + std::to_string(viewer.port())});
    Process run(test::launch_words(graph_file("cornell.lua"), picture, words));
    EXPECT_EQ(run.wait(), 0) << run.output();
    EXPECT_EQ(test::bytes_of(picture), plain.picture);
    ASSERT_TRUE(viewer.wait_for([](const auto& seen) { return !seen.opened.empty(); })) << run.output();
    const auto seen = viewer.seen();
    EXPECT_THAT(seen.errors, IsEmpty());
    EXPECT_EQ(seen.opened.front(), picture);
    EXPECT_GT(seen.updates, 0);
}
INSTANTIATE_TEST_SUITE_P(InEveryMode, TevModes,
                         testing::Values(std::vector<std::string>{"--threads", "1"},
                                         std::vector<std::string>{"--threads", "2"},
                                         std::vector<std::string>{"--local-workers", "2"}));

TEST(TevRun, GoesOnWhileTheViewerIsKilledAndComesAgain) {
    const Folder folder;
    auto viewer = std::make_unique<TevViewer>();
    const auto port = viewer->port();
    Process run(test::launch_words(graph_file("cornell.lua"), folder / "x.exr",
                                   {"--threads", "2", "--samples", "1000000", "--size", "64x64", "--progress", "plain",
                                    "--preview", "tev:" + std::to_string(port)}));
    ASSERT_TRUE(viewer->wait_for([](const auto& seen) { return seen.updates > 0; })) << run.output();
    viewer.reset();
    ASSERT_TRUE(run.wait_for("it is called again")) << run.output();
    TevViewer again(port);
    EXPECT_TRUE(again.wait_for([](const auto& seen) { return seen.updates > 0; })) << run.output();
    run.signal(SIGINT);
    EXPECT_EQ(run.wait(), 130) << run.output();
    EXPECT_THAT(again.seen().opened, IsEmpty()) << "there is no finished picture";
    EXPECT_THAT(again.seen().errors, IsEmpty());
}

TEST(TevRun, GoesBeyondThisMachineOnlyWhenThatIsSaid) {
    const Folder folder;
    const auto refused = test::launch(graph_file("cornell.lua"), folder, {"--preview", "tev:10.0.0.7:14158"});
    EXPECT_EQ(refused.code, 2);
    EXPECT_THAT(refused.said, HasSubstr("--insecure"));
    const auto wrong = test::launch(graph_file("cornell.lua"), folder, {"--preview", "tev:desk:port"});
    EXPECT_EQ(wrong.code, 2);
    EXPECT_THAT(wrong.said, HasSubstr("like tev:desk:14158"));
}

}  // namespace
}  // namespace lightnet::tev_run_test
