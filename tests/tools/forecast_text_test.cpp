// Forecasts as people and programs read them, and hosts as a command line says them.
#include "tools/forecast/forecast_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.hpp"
#include "core/base/json.hpp"
#include "nodes/standard_nodes.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/schema.hpp"
#include "tools/cli/lay_out.hpp"
#include "tools/forecast/forecast_hosts.hpp"
#include "tools/forecast/recorded_run.hpp"

namespace lightnet::forecast_text_test {
namespace {

using testing::HasSubstr;

ForecastTable some_table() {
    ForecastTable table{"x.run.json", 10, 10.5, {"light", "image"}, 64, 48, 16, 2, {}};
    Forecast what;
    what.seconds = 7200, what.least = 7000, what.most = 7300, what.efficiency = 0.9;
    what.by_node = {3, 4};
    what.parts = {{BusyPart::What::node, "light", 0.95}};
    table.rows = {{2, 8, what}};
    return table;
}

TEST(ForecastText, TellsSecondsDoubtAndWhatToChange) {
    const auto text = to_text(some_table());
    EXPECT_THAT(text, HasSubstr("2 h 00 min"));
    EXPECT_THAT(text, HasSubstr("node 'light' (95 %)"));
    EXPECT_THAT(text, HasSubstr("put more replicas of 'light'"));
    EXPECT_NEAR(doubt_in(some_table()), 0.05, 1e-12);
}

TEST(ForecastText, SaysTimesAsPeopleDo) {
    EXPECT_EQ(duration_text(12.34), "12.3 s");
    EXPECT_EQ(duration_text(754.2), "12 min 34 s");
    EXPECT_EQ(duration_text(11400), "3 h 10 min");
}

TEST(ForecastText, IsJsonByItsSchema) {
    if (!test::schemas_can_be_checked()) GTEST_SKIP() << "Python's jsonschema is not here";
    const test::Folder folder;
    EXPECT_EQ(test::complaints_of_schema("forecast", folder.write("f.json", to_json(some_table()))), "");
}

TEST(RecordedRun, KnowsWhatMoved) {
    const std::vector<std::string> hosts{"tcp://a:1"}, others{"tcp://b:1", ""};
    EXPECT_EQ(move_said("caustic goes from tcp://a:1 to tcp://b:1, here"), (DrawnMove{"caustic", hosts, others}));
    EXPECT_EQ(move_said("soft comes to tcp://a:1"), (DrawnMove{"soft", {}, hosts}));
    EXPECT_EQ(move_said("soft leaves tcp://b:1, here"), (DrawnMove{"soft", others, {}}));
    EXPECT_THROW(move_said("soft stays"), Error);
}

TEST(ForecastHosts, AreSaidByNameAndPlaces) {
    ForecastHostsOptions options;
    options.hosts = {"fast=8", "slow=2"};
    options.line = "10Gbit,0.5ms";
    options.lines = {"slow=100Mbit,5ms"};
    options.memory = {"16G", "slow=512M"};
    options.speeds = {"slow=0.5"};
    options.processors = {"fast=1.5"};
    const auto crew = crew_called(options);
    ASSERT_EQ(crew.hosts.size(), 2u);
    EXPECT_EQ(crew.hosts[0].places, 8u);
    EXPECT_EQ(crew.hosts[0].line.bytes_per_second, 1.25e9);
    EXPECT_EQ(crew.hosts[0].memory, 16 * 0x1p30);
    EXPECT_EQ(crew.hosts[1].line.seconds, 5e-3);
    EXPECT_EQ(crew.hosts[1].speed, 0.5);
    EXPECT_EQ(crew.hosts[0].processors, 1.5);
    EXPECT_EQ(crew.hosts[1].power(), 1.0);
    EXPECT_EQ(crew.hosts[1].memory, 512 * 0x1p20);
}

TEST(ForecastHosts, ComplainOfWhatTheyDoNotUnderstand) {
    const auto wrong = [](ForecastHostsOptions options) {
        try {
            crew_called(options);
            return std::string();
        } catch (const UserError& error) {
            return std::string(error.what());
        }
    };
    ForecastHostsOptions many, fast, onix;
    many.hosts = {"a=many"};
    fast.hosts = {"a=1"}, fast.line = "fast";
    onix.hosts = {"onyx=1"}, onix.memory = {"onix=1G"};
    EXPECT_THAT(wrong(many), HasSubstr("NAME=PLACES"));
    EXPECT_THAT(wrong(fast), HasSubstr("10Gbit,0.1ms"));
    EXPECT_THAT(wrong(onix), HasSubstr("onyx"));
}

TEST(ForecastHosts, FillOneAfterTheOther) {
    const auto crew = crew_of_places(10, 4, {});
    ASSERT_EQ(crew.hosts.size(), 3u);
    EXPECT_EQ(crew.hosts[2].places, 2u);
}

TEST(ScaledCosts, CostAsMuchPerSample) {
    RunCosts costs;
    costs.nodes = {{"light", 1e-6}, {"image", 0.1}};
    costs.edges = {{1, 0, 100, 60}};
    costs.image = 1;
    costs.picture = {64, 64, 4, 32};
    const auto more = scaled(costs, {0, 0, 64, 16, 3});
    EXPECT_NEAR(more.nodes[1].seconds, 0.1 * 4 / 4, 1e-12);  // a quarter of the pixels, four times the samples
    EXPECT_NEAR(more.edges[0].questions, 100, 1e-9);
    EXPECT_EQ(more.picture.frames, 3u);
}

TEST(ScaledCosts, GrowWithThePictureWhereItIsLearntFrom) {
    RunCosts costs;
    costs.nodes = {
        {"map", 1e-6, {10, 4, 0.1, 1000, 2}, 3000}, {"records", 1e-6, {10, 4, 0.1, 1000, 2, true}, 3000}, {"image", 1}};
    costs.image = 2;
    costs.picture = {64, 64, 4, 32};
    const auto more = scaled(costs, {256, 256});
    EXPECT_EQ(more.nodes[0].preparing.shard_seconds, 4);
    const double larger = std::pow(4, 0.8);  // as measured
    EXPECT_NEAR(more.nodes[1].preparing.shard_seconds, 4 * larger, 1e-9);
    EXPECT_NEAR(more.nodes[1].preparing.own_seconds, 0.1 * larger, 1e-9);
    EXPECT_NEAR(more.nodes[1].memory, 3000 * larger, 1e-9);
    EXPECT_EQ(more.nodes[1].preparing.shards, 31u);
}

TEST(LaidOut, IsAHostsFileForPeople) {
    Hosts hosts;
    hosts.hosts = {{"tcp://a:1", {}, 4, {}}, {"tcp://b:1", {{"soft", 2}}, 2, {}, "KEY"}};
    EXPECT_EQ(hosts_file_text(hosts, {"soft is not on tcp://a:1: it is quicker so"}),
              "-- Laid out by lightnet.\n-- soft is not on tcp://a:1: it is quicker so\n"
              "place \"tcp://a:1\" { places = 4 }\n"
              "place \"tcp://b:1\" { soft = 2, places = 2, key = \"KEY\" }\n");
}

TEST(LaidOut, WantsHostsAndKnowsItsWords) {
    RunningOptions running;
    EXPECT_EQ(mistaken_layout(running), std::nullopt);
    running.layout = "auto";
    EXPECT_THAT(*mistaken_layout(running), HasSubstr("--hosts"));
    running.hosts = "a.lua";
    EXPECT_EQ(mistaken_layout(running), std::nullopt);
    running.layout = "clever";
    EXPECT_THAT(*mistaken_layout(running), HasSubstr("auto=X.run.json"));
}

}  // namespace
}  // namespace lightnet::forecast_text_test
