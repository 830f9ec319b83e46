// What the user sees of a run, with a clock that the test holds.
#include "tools/support/progress.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

namespace lightnet::progress_test {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::Not;

const Progress::Time start{};

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

TEST(Progress, IsABarOnATerminalAndLinesElsewhere) {
    std::ostringstream terminal, file;
    Progress on_terminal(10, {ProgressMode::automatic, true, false}, terminal, start);
    Progress in_file(10, {ProgressMode::automatic, false, false}, file, start);
    on_terminal.update(5, start + 5s);
    in_file.update(5, start + 5s);
    EXPECT_THAT(terminal.str(), HasSubstr("[===============               ]  50 %  5 s left"));
    EXPECT_EQ(file.str(), "done 50 %, 5 s left\n");
}

TEST(Progress, CountsDownToTheEndOfTheRunWhereThatComesFirst) {
    std::ostringstream file;
    Progress progress(100, {ProgressMode::plain, false, false}, file, start);
    progress.end_by(start + 20s);
    EXPECT_EQ(progress.seconds_left(start + 5s), 15.0) << "nothing is known of the work";
    progress.update(1, start + 10s);
    EXPECT_EQ(progress.seconds_left(start + 10s), 10.0);
    progress.update(80, start + 16s);
    EXPECT_EQ(progress.seconds_left(start + 16s), 4.0);
    progress.update(96, start + 19s);
    EXPECT_LT(progress.seconds_left(start + 19s), 1.0);
    EXPECT_EQ(progress.seconds_left(start + 21s), 0.0) << "late";
}

TEST(Progress, IsOfAllFramesOfASequence) {
    std::ostringstream terminal, file;
    const Progress::Series series{17, 1, 4, start};
    Progress::Style style{ProgressMode::bar, true, false};
    style.series = series;
    Progress bar(10, style, terminal, start + 10s);
    bar.phase("render", start + 10s);
    bar.update(5, start + 15s);
    EXPECT_THAT(terminal.str(), HasSubstr("frame 17 render [")) << terminal.str();
    EXPECT_THAT(terminal.str(), HasSubstr(" 38 %  25 s left")) << "of one frame and a half of four, in 15 s";
    style.mode = ProgressMode::json;
    Progress json(10, style, file, start + 10s);
    json.update(5, start + 15s);
    const auto line = nlohmann::json::parse(lines_of(file.str()).back());
    EXPECT_EQ(line["frame"], 17);
    EXPECT_EQ(line["frames_done"], 1);
    EXPECT_EQ(line["frames"], 4);
    EXPECT_EQ(line["seconds_left"], 25);
}

// Two frames of a sequence: the files of one are written while the next is rendered.
TEST(Progress, LeavesTheBarToTheRunThatGoesOnBesideIt) {
    std::ostringstream terminal;
    Progress progress(10, {ProgressMode::automatic, true, false}, terminal, start);
    progress.phase("render", start);
    progress.update(10, start + 500ms);
    progress.stand_aside();
    EXPECT_TRUE(terminal.str().ends_with("\r\x1b[K"));
    terminal.str("");
    progress.phase("write", start + 600ms);
    progress.finish(start + 700ms);
    EXPECT_EQ(terminal.str(), "") << "the line is another's";
    progress.insist("the disk is full");
    EXPECT_EQ(terminal.str(), "\r\x1b[Kthe disk is full\n") << "as the bar of the other run stands there";
    EXPECT_EQ(room_for_line(ProgressMode::automatic, false), "");
}

TEST(Progress, WritesNoEscapesOffATerminal) {
    std::ostringstream file;
    Progress progress(100, {ProgressMode::automatic, false, false}, file, start);
    progress.phase("render", start);
    for (std::uint64_t i = 0; i <= 100; ++i) progress.update(i, start + i * 1s);
    progress.say("a worker is gone");
    progress.finish(start + 100s);
    EXPECT_THAT(file.str(), Not(HasSubstr("\x1b")));
    EXPECT_THAT(file.str(), Not(HasSubstr("\r")));
}

TEST(Progress, SaysALineEveryTenPercentOrTenSeconds) {
    std::ostringstream quick, slow;
    Progress many(1000, {ProgressMode::plain, false, false}, quick, start);
    for (std::uint64_t i = 1; i <= 1000; ++i) many.update(i, start + i * 31ms);
    EXPECT_EQ(lines_of(quick.str()).size(), 10u);
    Progress few(1000, {ProgressMode::plain, false, false}, slow, start);
    for (std::uint64_t i = 1; i <= 35; ++i) few.update(i, start + i * 1s);
    EXPECT_EQ(lines_of(slow.str()).size(), 3u);
}

TEST(Progress, RedrawsABarTenTimesASecondAtMost) {
    std::ostringstream out;
    Progress progress(100000, {ProgressMode::bar, true, false}, out, start);
    for (std::uint64_t i = 1; i <= 10000; ++i) progress.update(i, start + i * 100us);
    const std::string text = out.str();
    EXPECT_LE(std::count(text.begin(), text.end(), '\r'), 11);
}

TEST(Progress, EstimatesTheTimeLeftFromTheSpeedSoFar) {
    std::ostringstream out;
    Progress progress(100, {ProgressMode::none, false, false}, out, start);
    EXPECT_EQ(progress.seconds_left(start + 1s), std::nullopt);
    progress.update(25, start + 10s);
    EXPECT_DOUBLE_EQ(progress.seconds_left(start + 10s).value(), 30);
    progress.update(100, start + 40s);
    EXPECT_EQ(progress.seconds_left(start + 40s), 0);
    EXPECT_EQ(out.str(), "");
}

TEST(Progress, DoesNotCountPreparationOrFoundWorkAsSpeed) {
    std::ostringstream out;
    Progress progress(100, {ProgressMode::none, false, false}, out, start);
    progress.phase("prepare", start);
    progress.phase("render", start + 100s);
    progress.found_done(50, start + 100s);
    progress.update(60, start + 110s);
    EXPECT_DOUBLE_EQ(progress.seconds_left(start + 110s).value(), 40);
}

TEST(Progress, SpeaksJsonByTheLine) {
    std::ostringstream out;
    Progress progress(4, {ProgressMode::json, true, false}, out, start);
    progress.phase("render", start);
    progress.update(1, start + 2s);
    progress.say("a \"quoted\" word");
    progress.update(4, start + 4s);
    progress.finish(start + 4s);
    const auto lines = lines_of(out.str());
    ASSERT_EQ(lines.size(), 6u);
    EXPECT_EQ(nlohmann::json::parse(lines[0])["format"], "lightnet progress 1");
    const auto second = nlohmann::json::parse(lines[2]);
    EXPECT_EQ(second["event"], "progress");
    EXPECT_EQ(second["done"], 1);
    EXPECT_EQ(second["seconds_left"], 6.0);
    EXPECT_EQ(nlohmann::json::parse(lines[3])["text"], "a \"quoted\" word");
    EXPECT_EQ(nlohmann::json::parse(lines[5])["event"], "finish");
}

TEST(Progress, GivesEachPhaseOneLine) {
    std::ostringstream out;
    Progress progress(4, {ProgressMode::plain, false, false}, out, start);
    progress.phase("prepare", start);
    progress.phase("render", start + 1500ms);
    progress.finish(start + 4s);
    EXPECT_EQ(out.str(), "prepare: 1.5 s\nrender: 2.5 s\n");
}

TEST(Progress, SaysNoPercentagesOfARunOfASecond) {
    std::ostringstream out;
    Progress progress(100, {ProgressMode::plain, false, false}, out, start);
    progress.phase("load", start);
    progress.phase("render", start + 100ms);
    for (std::uint64_t i = 1; i <= 100; ++i) progress.update(i, start + 100ms + i * 10ms);
    progress.phase("write", start + 1050ms);
    progress.finish(start + 1100ms);
    EXPECT_EQ(out.str(), "");
}

TEST(Progress, InsistsOnErrorsInEveryMode) {
    for (const auto mode : {ProgressMode::none, ProgressMode::plain, ProgressMode::bar}) {
        std::ostringstream out;
        Progress progress(4, {mode, true, false}, out, start);
        progress.insist("the disk is full");
        EXPECT_EQ(out.str(), "the disk is full\n");
    }
    std::ostringstream out;
    Progress progress(4, {ProgressMode::json, false, false}, out, start);
    progress.insist("the disk is full", {{"level", "error"}});
    const auto line = nlohmann::json::parse(lines_of(out.str()).at(1));
    EXPECT_EQ(line["text"], "the disk is full");
    EXPECT_EQ(line["level"], "error");
}

TEST(Progress, SaysNothingAtAllInModeNone) {
    std::ostringstream out;
    Progress progress(4, {ProgressMode::none, true, true}, out, start);
    progress.phase("prepare", start);
    progress.step("photons 1/1", 1, 2, start + 5s);
    progress.phase("render", start + 10s);
    progress.say("a worker is ready");
    progress.update(4, start + 20s);
    progress.finish(start + 20s);
    EXPECT_EQ(out.str(), "");
}

// Without escape sequences, what a terminal shows of one bar.
std::size_t longest_line(std::string text) {
    std::size_t longest = 0;
    for (std::size_t at = 0; at < text.size();) {
        const auto end = std::min(text.find_first_of("\r\n", at), text.size());
        auto line = text.substr(at, end - at);
        for (auto escape = line.find('\x1b'); escape != std::string::npos; escape = line.find('\x1b'))
            line.erase(escape, line.find_first_of("mK", escape) - escape + 1);
        longest = std::max(longest, line.size());
        at = end + 1;
    }
    return longest;
}

TEST(Progress, HasABarThatFitsIntoAnyTerminal) {
    for (const int columns : {16, 20, 30, 45, 60, 200}) {
        std::ostringstream out;
        Progress progress(1000, {ProgressMode::bar, true, true, [=] { return columns; }}, out, start);
        progress.phase("prepare", start);
        progress.step("a_node_of_a_very_long_name 1/3", 1, 2, start + 5s);
        progress.phase("render", start + 10s);
        progress.update(1, start + 20s);
        progress.update(500, start + 30s);
        EXPECT_LT(longest_line(out.str()), static_cast<std::size_t>(columns)) << out.str();
        EXPECT_EQ(out.str().find('\n'), out.str().rfind('\n')) << "only the line about the phase of 10 s";
        if (columns >= 45) {
            EXPECT_THAT(out.str(), HasSubstr("[\x1b[32m====")) << "45 columns are enough for a bar";
        }
    }
}

TEST(Progress, FollowsATerminalThatBecomesNarrower) {
    int columns = 80;
    std::ostringstream out;
    Progress progress(10, {ProgressMode::bar, true, false, [&] { return columns; }}, out, start);
    progress.update(5, start + 1s);
    EXPECT_GT(longest_line(out.str()), 40u);
    columns = 40;
    out.str("");
    progress.update(6, start + 2s);
    EXPECT_LT(longest_line(out.str()), 40u);
}

TEST(Progress, LeavesNoFullBarBehind) {
    std::ostringstream out;
    Progress progress(10, {ProgressMode::bar, true, false}, out, start);
    progress.update(10, start + 1s);
    progress.finish(start + 1s);
    EXPECT_TRUE(out.str().ends_with("\r\x1b[K")) << "the summary says what there is to say";
    std::ostringstream broken;
    Progress unfinished(10, {ProgressMode::bar, true, false}, broken, start);
    unfinished.update(3, start + 1s);
    unfinished.finish(start + 1s);
    EXPECT_TRUE(broken.str().ends_with("30 %  2 s left\n")) << "how far it came";
}

TEST(Progress, TellsHowFarPreparingIsAndHowLongItWillTake) {
    std::ostringstream terminal, file, json;
    Progress bar(10, {ProgressMode::bar, true, false}, terminal, start);
    Progress plain(10, {ProgressMode::plain, false, false}, file, start);
    Progress lines(10, {ProgressMode::json, false, false}, json, start);
    for (auto* progress : {&bar, &plain, &lines}) {
        progress->phase("prepare", start);
        progress->step("photons 1/2", 0, 200, start + 10s);
        progress->step("photons 1/2", 50, 200, start + 20s);
    }
    EXPECT_THAT(terminal.str(), HasSubstr("photons 1/2 [=======                       ]  25 %  30 s left"));
    EXPECT_THAT(file.str(), HasSubstr("prepare photons 1/2 25 %, 30 s left\n"));
    const auto last = nlohmann::json::parse(lines_of(json.str()).back());
    EXPECT_EQ(last["event"], "step") << "no progress of the picture";
    EXPECT_EQ(last["step"], "photons 1/2");
    EXPECT_EQ(last["step_done"], 50);
    EXPECT_EQ(last["done"], 0);
    EXPECT_EQ(last["seconds_left"], 30.0);
    bar.step("photons 1/2", 10, 200, start + 30s);
    EXPECT_EQ(bar.seconds_left(start + 31s), 1.0 / 10 * 190) << "another step of the same length has begun";
    bar.phase("render", start + 40s);
    EXPECT_EQ(bar.seconds_left(start + 41s), std::nullopt) << "preparing says nothing about the speed of rendering";
}

TEST(Progress, UsesColourOnlyWhenAsked) {
    std::ostringstream grey, green;
    Progress(2, {ProgressMode::bar, true, false}, grey, start).update(1, start + 1s);
    Progress(2, {ProgressMode::bar, true, true}, green, start).update(1, start + 1s);
    EXPECT_THAT(grey.str(), Not(HasSubstr("\x1b[32m")));
    EXPECT_THAT(green.str(), HasSubstr("\x1b[32m"));
}

TEST(Progress, KnowsItsModesByName) {
    EXPECT_EQ(progress_mode("auto"), ProgressMode::automatic);
    EXPECT_EQ(progress_mode("json"), ProgressMode::json);
    EXPECT_EQ(progress_mode("fancy"), std::nullopt);
}

}  // namespace
}  // namespace lightnet::progress_test
