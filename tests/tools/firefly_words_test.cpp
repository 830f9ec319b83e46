// Words about noise name the paths that make it, and a graph that covers them where the one that ran does not.
#include <gmock/gmock.h>

#include "tools/session/firefly_words.hpp"

namespace lightnet::firefly_words_test {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr std::uint32_t side = 64;

Picture picture_with(Rgb firefly, const char* layer) {
    Picture picture;
    picture.width = picture.height = side;
    picture.layers.push_back({layer, std::vector<Rgb>(side * side, Rgb{0.5f, 0.5f, 0.5f})});
    picture.layers[0].pixels[7 * side + 21] = firefly;
    return picture;
}

RunReport report_of(const std::vector<const char*>& kinds) {
    RunReport report;
    for (const char* kind : kinds) report.nodes.emplace_back().kind = kind;
    return report;
}

RunReport with_noise(RunReport report, std::vector<std::pair<std::string, double>> paths, double error = 0.05) {
    report.noise = NoiseReport{error, 100, std::move(paths)};
    return report;
}

const Picture firefly = picture_with({900, 900, 900}, "bounce"), even = picture_with({0.5f, 0.5f, 0.5f}, "bounce");

TEST(FireflyWords, NameTheGraphThatCoversWhatPathsMeetByChance) {
    const auto words = firefly_words(firefly, report_of({"PathTracing"}), "x.exr");
    EXPECT_THAT(words, HasSubstr("1 pixel holds 99 % of the noise"));
    EXPECT_THAT(words, HasSubstr("lightnet explain x.exr 21,7"));
    EXPECT_THAT(words, HasSubstr("graphs/progressive.lua"));
}

TEST(FireflyWords, NameThePathsWhereTheyAreKnown) {
    const auto report = with_noise(report_of({"PathTracing"}), {{"LD", 0.1}, {"LS+D", 0.85}});
    EXPECT_THAT(firefly_words(firefly, report, "x.exr"),
                HasSubstr("1 pixel holds 99 % of the noise; paths LS+D make 85 % of it: graphs/progressive.lua"));
}

TEST(FireflyWords, SayWhereNothingBetterIsKnown) {
    const auto report = with_noise(report_of({"PathTracing"}), {{"LD", 0.9}, {"LS+D", 0.05}});
    const auto words = firefly_words(firefly, report, "x.exr");
    EXPECT_THAT(words, HasSubstr("paths LD make 90 % of it: no graph is known"));
    EXPECT_THAT(words, Not(HasSubstr("progressive.lua")));
}

TEST(FireflyWords, TellOfNoiseThatIsEverywhereWhereAGraphIsBetter) {
    const auto caustic = with_noise(report_of({"PathTracing"}), {{"LD", 0.1}, {"LS+D", 0.4}, {"LD+S+D", 0.45}});
    EXPECT_EQ(
        firefly_words(even, caustic, "x.exr"),
        "noise: paths LS+D and LD+S+D make 85 % of the error (relative square 0.05): graphs/progressive.lua covers "
        "these better");
    const auto unseen = with_noise(report_of({"PathTracing"}), {{"LS+D", 0.9}}, 1e-4);
    EXPECT_EQ(firefly_words(even, unseen, "x.exr"), "");
    const auto soft = with_noise(report_of({"PathTracing"}), {{"LD+D", 0.9}});
    EXPECT_EQ(firefly_words(even, soft, "x.exr"), "");
}

TEST(FireflyWords, NameNoGraphWherePhotonsAreThere) {
    for (const char* kind : {"ProgressivePhotonMapping", "PhotonMap"}) {
        const auto report = report_of({"PathTracing", kind});
        EXPECT_THAT(firefly_words(firefly, report, "x.exr"), Not(HasSubstr("progressive.lua")));
        EXPECT_THAT(firefly_words(firefly, with_noise(report, {{"LS+D", 0.9}}), "x.exr"),
                    Not(HasSubstr("progressive.lua")));
    }
}

TEST(FireflyWords, AreNoneOfLampsThatAreSeenOrOfPicturesWithoutFireflies) {
    EXPECT_EQ(firefly_words(picture_with({900, 900, 900}, "emission"), report_of({"PathTracing"}), "x.exr"), "");
    EXPECT_EQ(firefly_words(even, report_of({"PathTracing"}), "x.exr"), "");
}

}  // namespace
}  // namespace lightnet::firefly_words_test
