// The report holds what the run did.
#include "tools/support/run_report.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/film/pictures.hpp"

namespace lightnet::run_report_test {
namespace {

RunReport small_report() {
    RunReport report;
    report.graph = "cornell.lua";
    report.mode = "threads";
    report.places = {{"", 0, {"direct", "image"}}, {"tcp://onyx1:7777", 1, {"direct"}}};
    report.phases = {{"load", 0.5}, {"render", 12.25}};
    report.moves = {{7, 4.5, 0.25, {"direct goes from a to b"}}};
    report.counters = {{"questions", 18446744073709551615ull}, {"tiles", 64}};
    report.settings = {{"samples", "16"}};
    report.warnings = {"a \"quoted\" name"};
    return report;
}

TEST(RunReport, IsJsonThatSaysWhatRanWhere) {
    const auto json = nlohmann::json::parse(to_json(small_report()));
    EXPECT_EQ(json["outcome"], "done");
    EXPECT_EQ(json["graph"]["file"], "cornell.lua");
    EXPECT_EQ(json["places"][1]["host"], "tcp://onyx1:7777");
    EXPECT_EQ(json["places"][0]["nodes"][1], "image");
    EXPECT_EQ(json["phases"][1]["seconds"], 12.25);
    EXPECT_EQ(json["moves"][0]["seconds"], 4.5);
    EXPECT_EQ(json["moves"][0]["nodes"][0], "direct goes from a to b");
    EXPECT_EQ(json["counters"]["questions"], 18446744073709551615ull);
    EXPECT_EQ(json["warnings"][0], "a \"quoted\" name");
}

TEST(RunReport, KeepsAListWhereThereIsNothing) {
    const auto json = nlohmann::json::parse(to_json(RunReport{}));
    EXPECT_TRUE(json["places"].is_array());
    EXPECT_TRUE(json["phases"].is_array());
    EXPECT_TRUE(json["counters"].is_object());
}

TEST(RunReport, SurvivesNamesInNoKnownEncoding) {
    RunReport report = small_report();
    report.graph = "caf\xe9.lua";
    EXPECT_TRUE(nlohmann::json::accept(to_json(report)));
}

TEST(RunReport, IsWrittenToAFile) {
    const Folder folder;
    write_report(folder / "x.run.json", small_report());
    EXPECT_EQ(content_of(folder / "x.run.json"), to_json(small_report()));
}

}  // namespace
}  // namespace lightnet::run_report_test
