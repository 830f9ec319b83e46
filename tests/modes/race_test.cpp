// Runs that are held against each other.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "tests/modes/daemons.hpp"

namespace lightnet::race_test {
namespace {

using test::bytes_of;
using test::graph_file;
using test::program;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using Words = std::vector<std::string>;

class Race : public ::testing::Test {
protected:
    struct Ended {
        int code = -1;
        std::string said;
    };
    static Ended run(Words words) {
        words.insert(words.begin(), program("lightnet"));
        test::Process process(words);
        const int code = process.wait(test::slowdown * std::chrono::seconds(60));
        return {code, process.output()};
    }
    // What all are to come near.
    std::string reference() const {
        const auto file = (folder / "reference.exr").string();
        const auto made = run({"run", graph_file("cornell.lua"), "--size", "24x24", "--samples", "512", "-o", file});
        EXPECT_EQ(made.code, 0) << made.said;
        return file;
    }
    static std::vector<Words> rows_of(const std::string& csv) {
        std::vector<Words> rows;
        std::istringstream lines(csv);
        for (std::string line; std::getline(lines, line);) {
            auto& row = rows.emplace_back();
            std::istringstream in(line);
            for (std::string cell; std::getline(in, cell, ',');) row.push_back(cell);
        }
        return rows;
    }
    const test::Folder folder;
};

TEST_F(Race, GivesAllTheSameTimeInTurnsAndDrawsTheirCurves) {
    const auto page = (folder / "race.html").string(), csv = (folder / "race.csv").string();
    const auto ended =
        run({"race", graph_file("cornell.lua"), graph_file("direct.lua"), "--reference", reference(), "--seconds",
             "0.5", "--seeds", "2", "--size", "24x24", "--threads", "1", "-o", page, "--csv", csv});
    ASSERT_EQ(ended.code, 0) << ended.said;
    const auto turn = [&](const std::string& who) { return ended.said.find(who); };
    EXPECT_LT(turn("cornell, seed 1"), turn("direct, seed 1"));
    EXPECT_LT(turn("direct, seed 1"), turn("cornell, seed 2"));
    const auto rows = rows_of(bytes_of(csv));
    double path = 0, direct = 0;
    for (const auto& row : rows) {
        if (row.size() < 9 || row[0] == "name") continue;
        EXPECT_LT(std::stod(row[3]), 0.9) << "seconds of preparing and rendering";
        (row[0] == "cornell" ? path : direct) = std::stod(row[4]);
    }
    EXPECT_LT(0, path);
    EXPECT_LT(10 * path, direct) << "direct light alone stays far away, however long it takes";
    const auto html = bytes_of(page);
    EXPECT_THAT(html, StartsWith("<!DOCTYPE html>"));
    EXPECT_THAT(html, HasSubstr("<polyline"));
    EXPECT_THAT(html, HasSubstr("direct: FLIP"));
    EXPECT_THAT(html, Not(HasSubstr("<script")));
    EXPECT_THAT(html, Not(HasSubstr("http")));
}

TEST_F(Race, SaysAllThatIsWrongBeforeItBegins) {
    const auto other = folder.write("race.html", "<p>mine</p>");
    const auto taken = run({"race", graph_file("cornell.lua"), "--reference", reference(), "-o", other});
    EXPECT_EQ(taken.code, 2);
    EXPECT_THAT(taken.said, StartsWith(other + ": "));
    EXPECT_EQ(bytes_of(other), "<p>mine</p>");
    const auto missing = run({"race", graph_file("cornell.lua"), "--reference", "none.exr", "-o",
                              (folder / "x.html").string(), "--csv", (folder / "x.csv").string()});
    EXPECT_EQ(missing.code, 2);
    EXPECT_THAT(missing.said, HasSubstr("none.exr: can't be read"));
}

TEST_F(Race, SweepsAllCombinationsAndSeeds) {
    const auto csv = (folder / "sweep.csv").string();
    const auto ended = run({"sweep", graph_file("cornell.lua"), "-D", "samples=4,64", "--seed", "1-3", "--size",
                            "24x24", "--reference", reference(), "--threads", "1", "--csv", csv});
    ASSERT_EQ(ended.code, 0) << ended.said;
    EXPECT_THAT(ended.said, HasSubstr("samples=64"));
    std::map<std::string, double> worst, best;
    int runs = 0;
    for (const auto& row : rows_of(bytes_of(csv))) {
        if (row.size() < 9 || row[0] == "name") continue;
        ++runs;
        const double error = std::stod(row[4]);
        auto& least = best.try_emplace(row[0], error).first->second;
        least = std::min(least, error);
        worst[row[0]] = std::max(worst[row[0]], error);
        EXPECT_EQ("samples=" + row[2], row[0]);
    }
    EXPECT_EQ(runs, 6);
    EXPECT_LT(4 * worst["samples=64"], best["samples=4"]) << "16 times as many samples, 1/16 of the variance";
}

TEST_F(Race, SweepsNothingThatTheGraphDoesNotKnow) {
    const auto ended = run({"sweep", graph_file("cornell.lua"), "-D", "sampels=4,64"});
    EXPECT_EQ(ended.code, 2);
    EXPECT_THAT(ended.said, HasSubstr("sampels"));
}

}  // namespace
}  // namespace lightnet::race_test
