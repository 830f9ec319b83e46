// What the launcher says of wrong launches, before work starts.
#include <gtest/gtest.h>

#include "tests/network/daemons.hpp"

namespace lightnet::test {
namespace {

Launch launch_to(const std::string& output, const std::vector<std::string>& more = {}) {
    Process process(launch_words(graph_file("cornell.lua"), output, more));
    Launch launch;
    launch.code = process.wait();
    launch.said = process.output();
    return launch;
}

TEST(Launch, RefusesAnOutputThatCannotBeWrittenBeforeItRenders) {
    const Folder folder;
    const auto nowhere = launch_to(folder / "no" / "such" / "x.exr");
    EXPECT_EQ(nowhere.code, 2);
    EXPECT_NE(nowhere.said.find("there is no folder"), std::string::npos) << nowhere.said;
    const auto png = launch_to(folder / "x.png");
    EXPECT_EQ(png.code, 2);
    EXPECT_NE(png.said.find("written as .exr"), std::string::npos) << png.said;
}

TEST(Launch, TellsAllThatIsWrongWithASceneAtOnce) {
    const Folder folder;
    const auto scene = folder.write(
        "bad.pbrt", "WorldBegin\nMaterial \"difuse\"\nShape \"plymesh\" \"string filename\" \"none.ply\"\n");
    Process process(launch_words(graph_file("path.lua"), folder / "x.exr", {"-D", "file=" + scene}));
    EXPECT_EQ(process.wait(), 2);
    EXPECT_NE(process.output().find("bad.pbrt:2: Material 'difuse'"), std::string::npos) << process.output();
    EXPECT_NE(process.output().find("bad.pbrt:3: can't read 'none.ply'"), std::string::npos) << process.output();
}

TEST(Launch, WritesPictureTinyPictureAndReport) {
    const Folder folder;
    const auto run = launch(graph_file("cornell.lua"), folder, {"--size", "16x16", "--samples", "1"});
    ASSERT_EQ(run.code, 0) << run.said;
    EXPECT_EQ(bytes_of(folder / "picture.png").substr(1, 3), "PNG");
    EXPECT_GT(counter(run.report, "rays"), 0);
    EXPECT_NE(run.report.find("\"outcome\": \"done\""), std::string::npos);
}

}  // namespace
}  // namespace lightnet::test
