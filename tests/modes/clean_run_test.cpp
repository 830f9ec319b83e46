// Pictures are cleaned beside a run, later, and after mixing: the same bytes each time, whoever rendered.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "tests/modes/daemons.hpp"

namespace lightnet::test {
namespace {

using testing::HasSubstr;
using Words = std::vector<std::string>;

class CleanRun : public ::testing::Test {
protected:
    void render(const Words& more) const {
        Words words{"--size", "40x32", "--clean"};
        if (std::find(more.begin(), more.end(), "--samples") == more.end())
            words.insert(words.end(), {"--samples", "8"});
        words.insert(words.end(), more.begin(), more.end());
        Process run(with_environment(launch_words(graph_file("cornell.lua"), folder / "x.exr", words)));
        ASSERT_EQ(run.wait(), 0) << run.output();
    }
    std::string cleaned_in_run(const Words& more) const {
        render(more);
        return bytes_of(folder / "x.clean.exr");
    }
    std::string made(const Words& words, int code = 0) const {
        Words all{program("lightnet")};
        all.insert(all.end(), words.begin(), words.end());
        Process run(with_environment(all));
        EXPECT_EQ(run.wait(), code) << run.output();
        return run.output();
    }
    Words with_environment(const Words& words) const {
        Words all{"/usr/bin/env", "LIGHTNET_VECTORS=" + vectors};
        all.insert(all.end(), words.begin(), words.end());
        return all;
    }
    const Folder folder;
    std::string vectors;  // as wide as these; "": as wide as can be
};

TEST_F(CleanRun, GivesTheSameBytesInEveryMode) {
    const auto serial = cleaned_in_run({"--threads", "1"});
    EXPECT_FALSE(serial.empty());
    EXPECT_EQ(cleaned_in_run({"--threads", "3", "--tile", "11"}), serial);
    EXPECT_EQ(cleaned_in_run({"--local-workers", "2"}), serial);
}

TEST_F(CleanRun, EndsCellsByTheCleanedPictureInEveryMode) {
    const auto ended = [&](Words more) {
        more.insert(more.end(), {"--samples", "256", "--noise", "0.04"});
        const auto cleaned = cleaned_in_run(more);
        return cleaned + bytes_of(folder / "x.exr");
    };
    const auto serial = ended({"--threads", "1"});
    EXPECT_THAT(bytes_of(folder / "x.run.json"), HasSubstr("mean_samples"));
    EXPECT_TRUE(ended({"--threads", "3", "--tile", "11"}) == serial);
    EXPECT_TRUE(ended({"--local-workers", "2"}) == serial);
}

TEST_F(CleanRun, HasTheSameBytesWithNarrowVectors) {
    const auto wide = cleaned_in_run({"--threads", "1"});
    made({"clean", folder / "x.exr", "--best", "-o", folder / "wide.exr"});
    vectors = "narrow";
    EXPECT_EQ(cleaned_in_run({"--threads", "1"}), wide);
    made({"clean", folder / "x.exr", "--best", "-o", folder / "narrow.exr"});
    EXPECT_EQ(bytes_of(folder / "narrow.exr"), bytes_of(folder / "wide.exr"));
}

TEST_F(CleanRun, IsWhatTheVerbMakesLater) {
    const auto beside = cleaned_in_run({"--threads", "2"});
    made({"clean", folder / "x.exr", "-o", folder / "later.exr"});
    EXPECT_EQ(bytes_of(folder / "later.exr"), beside);
    EXPECT_TRUE(std::filesystem::exists(folder / "later.png"));
}

TEST_F(CleanRun, GivesItsNumbersAsArraysToo) {
    render({"--threads", "1", "--npz", folder / "x.npz"});
    made({"remix", folder / "x.clean.exr", "--keep-gains", "-o", folder / "y.exr", "--npz", folder / "y.npz"});
    const auto arrays = bytes_of(folder / "x.clean.npz");
    EXPECT_TRUE(arrays == bytes_of(folder / "y.npz"));
    EXPECT_FALSE(arrays == bytes_of(folder / "x.npz"));
}

TEST_F(CleanRun, ChangesNoLayerOfTheNoisyPicture) {
    render({"--threads", "2"});
    Process plain(launch_words(graph_file("cornell.lua"), folder / "plain.exr",
                               {"--size", "40x32", "--samples", "8", "--threads", "2"}));
    ASSERT_EQ(plain.wait(), 0) << plain.output();
    EXPECT_EQ(bytes_of(folder / "x.png"), bytes_of(folder / "plain.png"));
    EXPECT_THAT(made({"compare", folder / "plain.exr", folder / "x.exr"}), HasSubstr("bits equal"));
}

TEST_F(CleanRun, MayBeMixedBeforeOrAfterwards) {
    render({"--threads", "2"});
    const Words gains{"direct=0.25", "bounce=3,2,1"};
    const auto mixed = [&](const std::string& from, const std::string& to) {
        Words words{"remix", folder / from, "-o", folder / to};
        words.insert(words.end(), gains.begin(), gains.end());
        made(words);
    };
    mixed("x.clean.exr", "clean_then_mixed.exr");
    mixed("x.exr", "mixed.exr");
    made({"clean", folder / "mixed.exr", "-o", folder / "mixed_then_clean.exr"});
    EXPECT_EQ(bytes_of(folder / "clean_then_mixed.exr"), bytes_of(folder / "mixed_then_clean.exr"));
}

// Frames that help each other: in whatever order they are cleaned and mixed, and however many at once.
TEST_F(CleanRun, JoinsFramesOfASequence) {
    folder.write("shot.lua", "scene = Scene { '" + graph_file("") +
                                 "cornell_box.pbrt', camera = { from = keys { [1] = { 278, 273, -800 }, "
                                 "[3] = { 298, 273, -800 } }, to = { 278, 273, 280 } } }\n"
                                 "direct, bounce = DirectLighting {}, PathTracing {}\n"
                                 "light = Combine { direct, bounce }\nmotion = SurfaceFact { of = 'motion' }\n"
                                 "image = RayTracer { light, show = { motion }, scene = scene, samples = 8, "
                                 "film = { 40, 32, clean = true } }\n");
    made({"run", folder.file("shot.lua"), "--frames", "1-3", "-o", folder / "f.####.exr", "--threads", "2"});
    EXPECT_THAT(made({"clean", folder / "f.####.exr", "--across", "1", "-o", folder / "q.####.exr"}),
                HasSubstr("q.0003.exr"));
    const auto joined = bytes_of(folder / "q.0002.exr");
    EXPECT_NE(joined, bytes_of(folder / "f.0002.clean.exr"));
    made({"clean", folder / "f.####.exr", "--across", "1", "--frames", "2", "-o", folder / "one.####.exr"});
    EXPECT_TRUE(bytes_of(folder / "one.0002.exr") == joined);
    made({"clean", folder / "f.####.exr", "-o", folder / "alone.####.exr"});
    EXPECT_TRUE(bytes_of(folder / "alone.0002.exr") == bytes_of(folder / "f.0002.clean.exr"));

    made({"remix", folder / "q.####.exr", "bounce=2", "-o", folder / "clean_then_mixed.####.exr"});
    made({"remix", folder / "f.####.exr", "bounce=2", "-o", folder / "mixed.####.exr"});
    made({"clean", folder / "mixed.####.exr", "--across", "1", "-o", folder / "mixed_then_clean.####.exr"});
    EXPECT_TRUE(bytes_of(folder / "clean_then_mixed.0002.exr") == bytes_of(folder / "mixed_then_clean.0002.exr"));

    EXPECT_THAT(made({"clean", folder / "f.0002.exr", "--across", "1"}, 2), HasSubstr("is one picture"));
    EXPECT_THAT(made({"clean", folder / "f.####.exr", "-o", folder / "x.exr"}, 2), HasSubstr("name it like"));
    EXPECT_THAT(made({"remix", folder / "f.####.exr", "-o", folder / "x.exr"}, 2), HasSubstr("name it like"));
    render({"--threads", "2"});
    std::filesystem::rename(folder / "x.exr", folder / "x.01.exr");
    EXPECT_THAT(made({"clean", folder / "x.##.exr", "--across", "1"}, 2),
                HasSubstr("has no vectors to the next frame"));
}

TEST_F(CleanRun, RefusesWhatIsCleanAndSaysWhatIsLacking) {
    render({"--threads", "2"});
    EXPECT_THAT(made({"clean", folder / "x.clean.exr"}, 2), HasSubstr("is clean already"));
    EXPECT_THAT(made({"clean", folder / "x.exr", "-o", folder / "x.exr"}, 2), HasSubstr("would be lost"));
    Process plain(launch_words(graph_file("cornell.lua"), folder / "plain.exr", {"--size", "24x24", "--samples", "4"}));
    ASSERT_EQ(plain.wait(), 0) << plain.output();
    EXPECT_THAT(made({"clean", folder / "plain.exr"}), HasSubstr("halves"));
}

}  // namespace
}  // namespace lightnet::test
