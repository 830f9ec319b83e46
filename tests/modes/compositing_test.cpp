// Pictures that are ready for compositing have the same bytes in all modes, and are what other programs take them for.
// Each graph in graphs/ runs in all modes (same_image_test.cpp); here is what goes beyond that.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <csignal>
#include <cstdlib>

#include "tests/modes/daemons.hpp"

namespace lightnet::test {
namespace {

using testing::HasSubstr;
using Words = std::vector<std::string>;

class Compositing : public ::testing::Test {
protected:
    Launch rendered(const Words& more, const std::string& graph = graph_file("compositing.lua")) const {
        Process run(launch_words(graph, folder / "picture.exr", more));
        return finish(run, folder / "picture.exr");
    }
    // The graph, with something in it changed.
    std::string changed(const std::string& from, const std::string& to) const {
        folder.write("studio.pbrt", bytes_of(graph_file("studio.pbrt")));
        auto text = bytes_of(graph_file("compositing.lua"));
        const auto at = text.find(from);
        EXPECT_NE(at, std::string::npos);
        return folder.write("changed.lua", text.replace(at, from.size(), to));
    }
    const Folder folder;
};

TEST_F(Compositing, MattesAreThoseOfTheSpecification) {
    const auto picture = rendered({"--size", "64x48", "--samples", "24"});
    ASSERT_EQ(picture.code, 0) << picture.said;
    const auto script = std::string(LIGHTNET_SOURCE_DIR) + "/tests/modes/mattes.py";
    Process check({"/usr/bin/python3", script, folder / "picture.exr"});  // whose modules are packaged
    const int code = check.wait();
    constexpr int lacks_a_library = 77, lacks_python = 127;
    if (code == lacks_a_library || code == lacks_python) GTEST_SKIP() << check.output();
    EXPECT_EQ(code, 0) << check.output();
    EXPECT_THAT(check.output(), HasSubstr("'clay'"));
    EXPECT_THAT(check.output(), HasSubstr("CryptoLamp {'softbox'"));
}

TEST_F(Compositing, HasTheSameChannelsInPartsOfTheirOwn) {
    const auto whole = rendered({"--size", "32x24", "--samples", "4"});
    ASSERT_EQ(whole.code, 0) << whole.said;
    const auto remix = [&](const std::string& from, const std::string& how, const std::string& to) {
        Process process({program("lightnet"), "remix", folder / from, "--keep-gains", how, "-o", folder / to});
        EXPECT_EQ(process.wait(), 0) << process.output();
    };
    remix("picture.exr", "--parts", "parts.exr");
    remix("parts.exr", "--one-part", "one.exr");
    EXPECT_TRUE(bytes_of(folder / "one.exr") == whole.picture) << "and back";
    const auto script = std::string(LIGHTNET_SOURCE_DIR) + "/tests/modes/parts.py";
    Process check({"/usr/bin/python3", script, folder / "picture.exr", folder / "parts.exr"});
    const int code = check.wait();
    constexpr int lacks_a_library = 77, lacks_python = 127;
    if (code == lacks_a_library || code == lacks_python) GTEST_SKIP() << check.output();
    EXPECT_EQ(code, 0) << check.output();
    EXPECT_THAT(check.output(), HasSubstr("'rgba'"));
    const auto rendered_so =
        rendered({"--size", "32x24", "--samples", "4"}, changed("half = true", "half = true, parts = true"));
    EXPECT_TRUE(rendered_so.picture == bytes_of(folder / "parts.exr")) << "as the film says";
}

TEST_F(Compositing, TakesMoreSamplesLaterWithTheBytesOfAllAtOnce) {
    const auto at_once = rendered({"--size", "24x18", "--samples", "100", "--threads", "1"});
    ASSERT_EQ(at_once.code, 0) << at_once.said;
    for (const std::string samples : {"20", "72"}) {
        const Folder other;
        const auto in_two = [&](const std::string& count, const Words& mode) {
            Words words{"--size", "24x18", "--samples", count, "--resume"};
            words.insert(words.end(), mode.begin(), mode.end());
            return launch(graph_file("compositing.lua"), other, words);
        };
        ASSERT_EQ(in_two(samples, {"--threads", "2"}).code, 0);
        const auto all = in_two("100", {"--local-workers", "1"});
        EXPECT_TRUE(all.picture == at_once.picture) << all.said;
    }
}

TEST_F(Compositing, LosesNothingWithAHost) {
    const Words words{"--size", "48x36", "--samples", "256", "--tile", "16"};
    const auto alone = rendered(words);
    ASSERT_EQ(alone.code, 0) << alone.said;
    const Daemon lost(folder), healthy(folder);
    const auto hosts =
        folder.write("hosts.lua", "place '" + lost.endpoint + "' {}\nplace '" + healthy.endpoint + "' {}\n");
    auto more = words;
    more.insert(more.end(), {"--hosts", hosts, "--progress", "json"});
    Process run(launch_words(graph_file("compositing.lua"), folder / "picture.exr", more));
    ASSERT_TRUE(run.wait_for("\"event\":\"progress\"")) << run.output();
    lost.process->signal(SIGKILL);
    const auto together = finish(run, folder / "picture.exr");
    EXPECT_TRUE(together.picture == alone.picture) << together.said;
}

TEST_F(Compositing, IsTheSameWhereCellsDecideAboutTheirSamples) {
    const auto graph = changed("samples = 64,", "samples = 192, error = 0.05, least_samples = 32,");
    const Words words{"--size", "40x24"};
    const auto with = [&](Words more) {
        more.insert(more.end(), words.begin(), words.end());
        return rendered(more, graph);
    };
    const auto serial = with({"--threads", "1"});
    ASSERT_EQ(serial.code, 0) << serial.said;
    EXPECT_TRUE(with({"--threads", "3", "--tile", "8"}).picture == serial.picture);
    EXPECT_TRUE(with({"--local-workers", "2"}).picture == serial.picture);
}

TEST_F(Compositing, IsMixedAnewWithAllThatItHas) {
    const Words small{"--size", "24x18", "--samples", "8"};
    ASSERT_EQ(rendered(small).code, 0);
    Process remix({program("lightnet"), "remix", folder / "picture.exr", "key=0.3", "-o", folder / "mixed.exr"});
    ASSERT_EQ(remix.wait(), 0) << remix.output();
    auto with_gain = small;
    with_gain.insert(with_gain.end(), {"--gain", "key=0.3"});
    EXPECT_TRUE(rendered(with_gain).picture == bytes_of(folder / "mixed.exr"));
}

TEST_F(Compositing, SaysWhyAPictureIsNotCompressedWithLoss) {
    const auto refused = rendered({}, changed("compression = \"zips\"", "compression = \"dwaa\""));
    EXPECT_EQ(refused.code, 2);
    EXPECT_THAT(refused.said, HasSubstr("it is lossy, and layers would not add up any more"));
}

}  // namespace
}  // namespace lightnet::test
