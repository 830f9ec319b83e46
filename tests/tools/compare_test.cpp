// `lightnet compare`.
#include "tools/pictures/compare.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/film/exr.hpp"
#include "core/film/png.hpp"
#include "nodes/standard_nodes.hpp"
#include "tests/film/pictures.hpp"
#include "tools/cli/launcher.hpp"

namespace lightnet::compare_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// A reference, and pictures to hold against it.
class CompareVerb : public testing::Test {
protected:
    CompareVerb() {
        write_exr(reference, noisy_picture(40, 20));
        write_exr(same, noisy_picture(40, 20));
        Picture picture = noisy_picture(40, 20);
        for (Rgb& colour : picture.layers[1].pixels) colour *= 1.5f;
        picture.beauty = sum_of(picture.layers);
        write_exr(other, picture);
    }

    int compare(std::vector<std::string> words) {
        words.insert(words.begin(), "compare");
        std::ostringstream to_out, to_err;
        const int code = Launcher{registry_, [](const auto&) { return 7; }, to_out, to_err}(words);
        out = to_out.str(), err = to_err.str();
        return code;
    }

    const test::Folder folder_;
    const Registry registry_{standard_nodes()};
    const std::string reference = folder_ / "reference.exr", same = folder_ / "same.exr", other = folder_ / "other.exr";
    std::string out, err;
};

TEST_F(CompareVerb, TellsHowFarEachLayerIs) {
    EXPECT_EQ(compare({reference, same, other}), 0) << err << "only a stated tolerance can be passed";
    EXPECT_THAT(out, HasSubstr("same.exr: all bits are equal\n"));
    EXPECT_THAT(out, HasSubstr("other.exr: all bits are not equal\n"));
    EXPECT_THAT(out, testing::ContainsRegex("emission +FLIP 0.0000  relMSE 0  .*bits equal"));
    EXPECT_THAT(out, testing::ContainsRegex("Zenith +FLIP 0.* mean ratio 1.5000 1.5000 1.5000  bits differ"));
    EXPECT_THAT(out, HasSubstr("67 pixels per degree, exposure 0, clipped to 0..1, sRGB"));
}

TEST_F(CompareVerb, ExitsWithOneWhenAStatedToleranceIsPassed) {
    for (const char* option : {"--max-relmse", "--max-trimmed", "--max-blocks", "--max-bias", "--max-flip"}) {
        EXPECT_EQ(compare({reference, same, option, "0"}), 0) << option << err;
        EXPECT_EQ(compare({reference, other, option, "0"}), 1) << option;
        EXPECT_THAT(err, HasSubstr("other.exr: ")) << option;
        EXPECT_THAT(err, HasSubstr("is more than 0\n")) << option;
        EXPECT_EQ(compare({reference, other, option, "1e9"}), 0) << option << err;
    }
    EXPECT_EQ(compare({reference, same, "--equal-bytes"}), 0);
    EXPECT_EQ(compare({reference, same, other, "--equal-bytes"}), 1) << "one is enough";
    EXPECT_THAT(err, HasSubstr("other.exr: bits differ\n"));
}

TEST_F(CompareVerb, ExitsWithTwoWhenAPictureCannotBeRead) {
    EXPECT_EQ(compare({folder_ / "none.exr", same}), 2);
    EXPECT_THAT(err, HasSubstr("none.exr"));
    EXPECT_EQ(compare({reference, folder_ / "none.png", same}), 2);
    EXPECT_THAT(out, HasSubstr("same.exr: all bits are equal")) << "the others are compared";
    write_exr(folder_ / "small.exr", noisy_picture(4, 4));
    EXPECT_EQ(compare({reference, folder_ / "small.exr", "--max-flip", "0"}), 2);
    EXPECT_THAT(err, HasSubstr("40x20 pixels and one of 4x4"));
}

TEST_F(CompareVerb, SpeaksJson) {
    EXPECT_EQ(compare({reference, other, folder_ / "none.exr", "--json", "--max-relmse", "1e-9"}), 2);
    const auto json = nlohmann::json::parse(out);
    EXPECT_EQ(json["format"], "lightnet compare 1");
    EXPECT_EQ(json["flip"]["pixels_per_degree"], 67);
    const auto& image = json["images"][0];
    EXPECT_EQ(image["file"], other);
    EXPECT_EQ(image["identical"], false);
    EXPECT_EQ(image["layers"][0]["name"], "beauty");
    EXPECT_GT(image["layers"][0]["flip"], 0);
    EXPECT_NEAR(image["layers"][2]["mean_ratio"][1], 1.5, 1e-5);
    EXPECT_EQ(image["too_far"].size(), 1u);
    EXPECT_THAT(json["images"][1]["error"], HasSubstr("none.exr"));
}

TEST_F(CompareVerb, WritesPicturesOfTheDifference) {
    EXPECT_EQ(compare({reference, other, "--difference", folder_ / "d.exr", "--flip-map", folder_ / "f.png"}), 0)
        << err;
    const Picture difference = read_exr(folder_ / "d.exr");
    const Rgb before = noisy_picture(40, 20).layers[1].pixels[7];
    EXPECT_NEAR(difference.layers.at(1).pixels[7].r, before.r / 2, 1e-4f * before.r);
    EXPECT_TRUE(content_of(folder_ / "f.png").starts_with("\x89PNG"));
    EXPECT_EQ(compare({reference, other, "--difference", folder_ / "d.png"}), 0) << err;
    EXPECT_TRUE(content_of(folder_ / "d.png").starts_with("\x89PNG"));
    EXPECT_EQ(compare({reference, other, "--difference", folder_ / "d.jpg"}), 2);
    EXPECT_THAT(err, HasSubstr("d.jpg' must end in .exr or .png"));
    EXPECT_EQ(compare({reference, other, same, "--flip-map", folder_ / "f.png"}), 2);
    EXPECT_THAT(err, HasSubstr("--flip-map: takes one picture beside the reference"));
}

TEST_F(CompareVerb, TakesPicturesWithoutLayersToo) {
    write_png(folder_ / "a.png", read_exr(reference));
    EXPECT_EQ(compare({folder_ / "a.png", folder_ / "a.png", "--equal-bytes"}), 0) << err;
    EXPECT_EQ(compare({reference, folder_ / "a.png", "--max-flip", "0.01"}), 0) << err << "an EXR looks like its PNG";
    EXPECT_THAT(out, HasSubstr("layer Zenith is only in the reference"));
}

}  // namespace
}  // namespace lightnet::compare_test
