// What the user sees of a run, with a clock that the test holds.
#include "core/film/progress.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

namespace lightnet {
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
    on_terminal.update(5, start + 1s);
    in_file.update(5, start + 1s);
    EXPECT_THAT(terminal.str(), HasSubstr("[===============               ]  50 %  1 s left"));
    EXPECT_EQ(file.str(), "done 50 %, 1 s left\n");
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
    for (std::uint64_t i = 1; i <= 1000; ++i) many.update(i, start + i * 1ms);
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
    ASSERT_EQ(lines.size(), 5u);
    const auto second = nlohmann::json::parse(lines[1]);
    EXPECT_EQ(second["event"], "progress");
    EXPECT_EQ(second["done"], 1);
    EXPECT_EQ(second["seconds_left"], 6.0);
    EXPECT_EQ(nlohmann::json::parse(lines[2])["text"], "a \"quoted\" word");
    EXPECT_EQ(nlohmann::json::parse(lines[4])["event"], "finish");
}

TEST(Progress, GivesEachPhaseOneLine) {
    std::ostringstream out;
    Progress progress(4, {ProgressMode::plain, false, false}, out, start);
    progress.phase("prepare", start);
    progress.phase("render", start + 1500ms);
    progress.finish(start + 4s);
    EXPECT_EQ(out.str(), "prepare: 1.5 s\nrender: 2.5 s\n");
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
}  // namespace lightnet
