// What a run says of its picture's noise: how much there is, and which light paths make it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/film/compare.hpp"
#include "core/film/exr.hpp"
#include "tests/modes/daemons.hpp"
#include "tests/support/schema.hpp"

namespace lightnet::noise_test {
namespace {

using namespace test;
using testing::HasSubstr;
using testing::Not;
using Words = std::vector<std::string>;
using Tree = nlohmann::json;

const std::string graphs = std::string(LIGHTNET_SOURCE_DIR) + "/graphs/";

class Noise : public ::testing::Test {
protected:
    Launch launched(const std::string& scene, Words more = {}) const {
        more.insert(more.begin(), {"-D", "file=" + graphs + scene, "--size", "96x96", "--progress", "plain"});
        Launch made = launch(graphs + "path_all.lua", folder, more);
        EXPECT_EQ(made.code, 0) << made.said;
        return made;
    }
    static double part(const Launch& made, const std::string& word) {
        const Tree report = Tree::parse(made.report);
        for (const auto& paths : report.at("noise").at("paths"))
            if (paths.at("word") == word) return paths.at("part");
        ADD_FAILURE() << word;
        return 0;
    }
    static double error(const Launch& made) { return Tree::parse(made.report).at("noise").at("relmse"); }
    // Of one picture: half of the square by which two differ.
    double error_between(const std::string& scene, const Words& more) const {
        Words other = more;
        other.insert(other.end(), {"--seed", "7"});
        launched(scene, other);
        const Picture first = read_exr(picture);
        launched(scene, more);
        return compare(first, read_exr(picture)).relative_square / 2;
    }
    const Folder folder;
    const std::string picture = folder / "picture.exr";
};

TEST_F(Noise, BelowABallOfGlassIsMadeByCausticsForWhichThereIsAGraph) {
    const Launch made = launched("glass_ball.pbrt");
    EXPECT_GT(part(made, "LS+D"), 0.6);
    EXPECT_THAT(made.said, HasSubstr("LS+D"));
    EXPECT_THAT(made.said, HasSubstr("graphs/progressive.lua covers these better"));
}

TEST_F(Noise, InARoomIsMadeBySoftLightForWhichNothingBetterIsNamed) {
    const Launch made = launched("cornell_box.pbrt");
    EXPECT_GT(part(made, "LD+D"), 0.6);
    EXPECT_THAT(made.said, Not(HasSubstr("covers these better")));
}

// A third of the pixels at most is looked at, each of which tells its variance by eight parts.
TEST_F(Noise, IsAsMuchAsTwoPicturesDiffer) {
    const Words more{"--samples", "64"};
    const double between = error_between("cornell_box.pbrt", more), told = error(launched("cornell_box.pbrt", more));
    EXPECT_GT(told, between / 2);
    EXPECT_LT(told, between * 2);
}

TEST_F(Noise, IsToldAlikeWhereverThePictureIsMade) {
    const auto noise = [&](const Words& mode) {
        return Tree::parse(launched("cornell_box.pbrt", mode).report).at("noise");
    };
    const Tree serial = noise({"--threads", "1"});
    EXPECT_EQ(noise({"--threads", "3"}), serial);
    EXPECT_EQ(noise({"--local-workers", "2"}), serial);
    const Daemon daemon(folder, 2);
    EXPECT_EQ(noise({"--hosts", folder.write("hosts.lua", "place '" + daemon.endpoint + "' {}\n")}), serial);
}

TEST_F(Noise, IsToldByTheWordsOfARunOnHosts) {
    EXPECT_THAT(launched("glass_ball.pbrt", {"--local-workers", "2"}).said,
                HasSubstr("graphs/progressive.lua covers these better"));
}

// Its launcher would have to build the scene for 64 samples.
TEST_F(Noise, OfASmallPictureByHostsIsNotWorthTheTreesOfItsScene) {
    const auto is_told = [&](const char* mode) {
        return Tree::parse(launched("cornell_box.pbrt", {"--samples", "4", "--size", "4x4", mode, "1"}).report)
            .contains("noise");
    };
    EXPECT_TRUE(is_told("--threads"));
    EXPECT_FALSE(is_told("--local-workers"));
}

TEST_F(Noise, IsInTheReportAsTheSchemaSays) {
    if (!schemas_can_be_checked()) GTEST_SKIP() << "Python's jsonschema is not here";
    EXPECT_EQ(complaints_of_schema("run", folder.write("noise.json", launched("cornell_box.pbrt").report)), "");
}

// One sample of each pixel does not differ from itself.
TEST_F(Noise, IsUnknownWithOneSample) {
    EXPECT_FALSE(Tree::parse(launched("cornell_box.pbrt", {"--samples", "1"}).report).contains("noise"));
}

}  // namespace
}  // namespace lightnet::noise_test
