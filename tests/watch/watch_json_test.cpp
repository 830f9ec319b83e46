// What a page is told of a run.
#include "tools/watch/watch_json.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "core/network/graph/layout.hpp"
#include "tests/support/parse.hpp"

namespace lightnet::watch_json_test {
namespace {

using test::fake_registry;
using test::sound_graph;
using testing::ElementsAre;

const Graph& small_graph() {
    static const Graph graph =
        sound_graph("a = Ambient {} b = Ambient {} inner = Combine { a, b } lighting = Cache { inner }");
    return graph;
}

TEST(WatchedRunJson, SaysWhichColoursAreThePictureOfEachNode) {
    const Registry registry = fake_registry();
    const Graph graph = sound_graph("a = Ambient {} b = Ambient {} lighting = Combine { a, b }");
    const FilmFormat format{8, 4, layers_of(graph, registry).film, 16};
    const auto hello = nlohmann::json::parse(hello_json({graph, registry, format, "x.exr"}))["hello"];
    EXPECT_THAT(hello["nodes"][0]["picture"], ElementsAre(1));
    EXPECT_THAT(hello["nodes"][2]["picture"], ElementsAre(1, 2));
    EXPECT_THAT(hello["nodes"][4]["picture"], ElementsAre(0, 1, 2)) << hello["nodes"];
    EXPECT_THAT(hello["edges"], ElementsAre(ElementsAre(2, 0), ElementsAre(2, 1), ElementsAre(4, 2)));
    EXPECT_EQ(hello["levels"].size(), 255u);
}

TEST(WatchedRunJson, NamesLayersWithoutNoiseBehindTheOthers) {
    const Registry registry = fake_registry();
    const FilmFormat format{8, 4, {"a", "b"}, 16, {}, {}, {}, {"half.a", "half.b"}};
    const auto hello = nlohmann::json::parse(hello_json({small_graph(), registry, format, "x.exr"}))["hello"];
    EXPECT_EQ(hello["cleaned"], 4);
    ASSERT_EQ(hello["colours"].size(), 6u);
    EXPECT_EQ(hello["colours"][5]["name"], "clean.b");
    EXPECT_EQ(hello["colours"][5]["layer"], false);
    const FilmFormat plain{8, 4, {"a"}, 16};
    const auto without = nlohmann::json::parse(hello_json({small_graph(), registry, plain, "x.exr"}))["hello"];
    EXPECT_FALSE(without.contains("cleaned"));
}

TEST(WatchedRunJson, TellsTheFramesOfASequence) {
    const Registry registry = fake_registry();
    const FilmFormat format{8, 4, {"a"}, 16};
    WatchedRun frame{small_graph(), registry, format, "x.0002.exr"};
    EXPECT_FALSE(nlohmann::json::parse(hello_json(frame))["hello"].contains("frames"));
    frame.frames = {2, {{1, "done"}, {2, ""}, {3, ""}}};
    const auto frames = nlohmann::json::parse(hello_json(frame))["hello"]["frames"];
    EXPECT_EQ(frames["at_work"], 2);
    EXPECT_EQ(frames["all"], nlohmann::json::parse(R"([[1,"done"],[2,""],[3,""]])"));
}

TEST(WatchedStateJson, AddsUpWhatHostsSay) {
    const HostFigures figures{{{1, 2, 3, 4}}, std::vector<NodeFigures>(6, {1, 2, 3, 4, 5, 6, 7}), {{8, 1, 2, 3}, {9}}};
    WatchedState state;
    state.hosts = {{"one", "is ready", true, 1, 5, {}, figures}, {"two", "is ready", true, 1, 5, {}, figures}};
    const auto json = nlohmann::json::parse(state_json(state, small_graph()));
    EXPECT_THAT(json["nodes"][1], ElementsAre(2, 4, 6, 8, 10, 12, 14));
    EXPECT_THAT(json["edges"], ElementsAre(ElementsAre(16, 2, 4, 6), ElementsAre(18, 0, 0, 0)));
    EXPECT_THAT(json["hosts"][1]["looks"], ElementsAre(ElementsAre(1, 2, 3, 4)));
}

TEST(WatchedStateJson, HasARowForEachHostWhereThereAreManyPlaces) {
    WatchedState state;
    for (int i = 0; i < 1000; ++i) {
        HostFigures figures;
        figures.places.resize(16, {1, 1, 1, 1});
        state.hosts.push_back({"tcp://10.0.0.1:" + std::to_string(i), "is ready", true, 16, 5, {}, figures});
    }
    state.hosts.resize(100);
    const auto text = state_json(state, small_graph());
    EXPECT_THAT(nlohmann::json::parse(text)["hosts"][99]["looks"], ElementsAre(ElementsAre(16, 16, 16, 16)));
}

TEST(WatchedStateJson, HasTheForecastOfARunThatIsOver) {
    WatchedState state;
    EXPECT_FALSE(nlohmann::json::parse(state_json(state, small_graph())).contains("forecast"));
    Forecast two;
    two.seconds = 5, two.least = 4, two.most = 6, two.efficiency = 0.9;
    two.parts = {{BusyPart::What::node, "lighting", 0.8}};
    state.forecast = {.per_host = 8, .rows = {{1, 2, two}}, .places = 2, .seconds = 5.5, .doubt = 0.5};
    const auto forecast = nlohmann::json::parse(state_json(state, small_graph()))["forecast"];
    EXPECT_EQ(forecast["per_host"], 8);
    EXPECT_EQ(forecast["seconds"], 5.5);
    EXPECT_THAT(forecast["rows"], ElementsAre(ElementsAre(2, 5, 2, 9, 0.9, "node 'lighting'")));
}

// As the run's report says it.
TEST(WatchedStateJson, TellsWhichNodesMovedWhenAndWhy) {
    WatchedState state;
    EXPECT_FALSE(nlohmann::json::parse(state_json(state, small_graph())).contains("moves"));
    state.moves = {{1, 2.5, 0.25, {"direct goes from a to b", "both goes from a to c"}},
                   {2, 7, 1, {"direct goes to c"}}};
    const auto moves = nlohmann::json::parse(state_json(state, small_graph()))["moves"];
    ASSERT_EQ(moves.size(), 2u);
    EXPECT_EQ(moves[0]["seconds"], 2.5);
    EXPECT_EQ(moves[0]["gain"], 0.25);
    EXPECT_THAT(moves[0]["nodes"], ElementsAre("direct goes from a to b", "both goes from a to c"));
    std::ifstream file(std::string(LIGHTNET_SOURCE_DIR) + "/docs/schemas/run.schema.json");
    const auto schema = nlohmann::json::parse(file)["properties"]["moves"]["items"]["properties"];
    ASSERT_EQ(moves[0].size(), schema.size());
    for (const auto& [key, value] : moves[0].items()) EXPECT_TRUE(schema.contains(key)) << key;
}

TEST(WatchedStateJson, StaysSmallWithAThousandHosts) {
    WatchedState state;
    for (int i = 0; i < 1000; ++i) {
        HostFigures figures;
        figures.places.resize(16, {1, 1, 1, 1});
        state.hosts.push_back({"tcp://10.0.0.1:" + std::to_string(i), "is ready", i != 777, 16, 5, {}, figures});
    }
    const auto text = state_json(state, small_graph());
    EXPECT_LT(text.size(), 20'000u);
    const auto hosts = nlohmann::json::parse(text)["hosts"];
    ASSERT_EQ(hosts.size(), 101u);
    const auto lost = std::count_if(hosts.begin(), hosts.end(), [](const auto& host) { return !host["there"]; });
    EXPECT_EQ(lost, 1) << "whoever is lost is named";
    EXPECT_EQ(hosts[100]["rest"], true);
    EXPECT_EQ(hosts[100]["name"], "900 more hosts");
    std::uint64_t looks = 0;
    for (const auto& host : hosts) looks += host["looks"][0][0].template get<std::uint64_t>();
    EXPECT_EQ(looks, 16'000u) << "of all places";
}

}  // namespace
}  // namespace lightnet::watch_json_test
