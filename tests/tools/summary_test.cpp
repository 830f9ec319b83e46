// The last words of a run.
#include "tools/support/summary.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lightnet::summary_test {
namespace {

using testing::HasSubstr;
using testing::Not;

class Summary : public testing::Test {
protected:
    Summary() {
        report.outputs = {"/tmp/x.exr", "/tmp/x.png"};
        report.phases = {{"load", 0.25}, {"render", 12}};
        report.settings = {{"size", "64x48"}, {"samples", "16"}};
        report.places = {{"here", 0, {}}, {"here", 1, {}}};
    }
    std::string text() const {
        return summary_of({report, {"emission", "direct"}, asked, brightness, exposure, chosen, shown});
    }

    RunReport report;
    Hosts asked;
    Brightness brightness;
    double exposure = 0, shown = 0;
    std::optional<double> chosen;
};

TEST_F(Summary, SaysWhatWasMadeAndWhereAndHowLongItTook) {
    EXPECT_EQ(text(),
              "wrote /tmp/x.exr, /tmp/x.png\n"
              "      64x48, 16 samples per pixel, layers: emission, direct\n"
              "took 12.2 s: load 0.2, render 12.0\n"
              "on    2 threads of this machine");
}

TEST_F(Summary, SaysHowManySamplesThereAreWhereCellsDecide) {
    report.settings["mean_samples"] = "9.50";
    EXPECT_THAT(text(), HasSubstr("9.50 of 16 samples per pixel on average, layers"));
}

TEST_F(Summary, NamesHostsThatTookPartWereLostOrNeverCame) {
    report.hosts = {{"tcp://a:1", "is ready", {}, {}, {}, {}, 4, 0, 4},
                    {"here", "is ready", {}, {}, {}, {}, 2, 0, 1},
                    {"tcp://b:1", "is lost: it does not answer", {}, {}, {}, {}, 0, 0, 0},
                    {"tcp://c:1", "does not answer", {}, {}, {}, {}, 0, 0, 0},
                    {"tcp://d:1", "is busy: it serves another run, of anna@vm (lab.lua)", {}, {}, {}, {}, 0, 0, 0}};
    asked.hosts = {{"tcp://a:1", {}, 0, {}},
                   {"tcp://c:1", {{"bounce", 2}, {"image", 1}}, 0, {}},
                   {"tcp://d:1", {}, 0, {}},
                   {"onyx1", {{"direct", 1}}, 0, {}},
                   {"here", {{"image", 1}}, 1, {}}};
    EXPECT_THAT(text(), HasSubstr("on    2 of 6 hosts with 5 places: tcp://a:1 (4 places), this process (1 place)\n"));
    EXPECT_THAT(text(), HasSubstr("\n      tcp://b:1 is lost: it does not answer\n"));
    EXPECT_THAT(text(), HasSubstr("\n      tcp://c:1 never came: it does not answer; it was to hold bounce, image\n"));
    EXPECT_THAT(text(),
                HasSubstr("\n      tcp://d:1 never came, as it is busy: it serves another run, of anna@vm (lab.lua)"
                          "; it was to hold the whole network\n"));
    EXPECT_THAT(text(), HasSubstr("\n      onyx1 never came; it was to hold direct"));
}

TEST_F(Summary, DoesNotListHundredsOfHosts) {
    for (int i = 0; i < 200; ++i)
        report.hosts.push_back({"h" + std::to_string(i), "is ready", {}, {}, {}, {}, 1, 0, 1});
    EXPECT_THAT(text(), HasSubstr("on    200 hosts with 200 places: h0 (1 place), "));
    EXPECT_THAT(text(), HasSubstr("h7 (1 place) and 192 more"));
}

TEST_F(Summary, HintsAtTheExposureThatShowsThePicture) {
    brightness = {.clipped = 0.995, .lit = 1, .high = 7.2f};  // log2(0.9 / 7.2) = -3
    chosen = 1;
    EXPECT_THAT(text(),
                HasSubstr("\nhint: 99 % of the pixels of the PNG are clipped; --exposure -2.0 would show them"));
    brightness = {.black = 0.8, .lit = 1, .high = 1e-4f, .lit_high = 1.0f / 1024};  // log2(512) = 9
    EXPECT_THAT(text(), HasSubstr("\nhint: 80 % of the pixels of the PNG are black; --exposure 10.0 would show them"));
}

TEST_F(Summary, TellsHowThePngDiffersFromTheExr) {
    brightness = {.black = 0.8, .lit = 1, .high = 1e-4f, .lit_high = 1.0f / 1024};
    shown = 9;
    EXPECT_THAT(
        text(),
        HasSubstr("\nhint: the PNG is 9.0 stops brighter than the EXR; exposure = 9.0 of the graph's scene does "
                  "that to both, --view plain to none"));
}

TEST_F(Summary, SaysThatNothingIsLitWhereNoExposureHelps) {
    brightness = {.black = 1};
    EXPECT_THAT(text(), HasSubstr("\nhint: nothing is lit: the scene lacks light"));
    brightness = {.black = 0.994, .lit = 0.006};
    EXPECT_THAT(text(), HasSubstr("\nhint: 99 % of the pixels are black: the scene lacks light"));
    EXPECT_THAT(text(), Not(HasSubstr("--exposure")));
}

}  // namespace
}  // namespace lightnet::summary_test
