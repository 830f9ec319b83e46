// The graphs that come with the project are sound.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "core/network/graph/check.hpp"
#include "core/network/graph/layout.hpp"
#include "core/network/graph/plan.hpp"
#include "lua/custom.hpp"
#include "lua/load_graph.hpp"
#include "nodes/examples/candela/candela_kinds.hpp"
#include "nodes/standard_nodes.hpp"

namespace lightnet::graphs_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

const std::filesystem::path graphs = std::filesystem::path(LIGHTNET_SOURCE_DIR) / "graphs";

Graph graph_called(const std::string& name) { return load_graph((graphs / name).string()); }

TEST(Graphs, AreSound) {
    Registry registry(standard_nodes());
    registry.add(candela_kinds());
    registry.add({custom_kind()});
    int count = 0;
    for (const auto& folder : {graphs, graphs / "paper"})
        for (const auto& entry : std::filesystem::directory_iterator(folder)) {
            if (entry.path().extension() != ".lua") continue;
            ++count;
            const Examined found = examine(load_graph(entry.path().string()), registry);
            EXPECT_THAT(found.problems, IsEmpty()) << entry.path();
            EXPECT_THAT(found.warnings, IsEmpty()) << entry.path();
        }
    EXPECT_GE(count, 4);
}

TEST(Graphs, LeaveOutOnlyTheLightThatTheyMeanTo) {
    const Registry registry(standard_nodes());
    for (const char* whole :
         {"cornell.lua", "path.lua", "path_all.lua", "weights.lua", "ambient.lua", "irradiance_cache.lua",
          "paper/figure5.lua", "paper/figure8.lua", "progressive.lua", "guided.lua"})
        EXPECT_THAT(examine(graph_called(whole), registry).notes, IsEmpty()) << whole;
    const auto notes = examine(graph_called("direct.lua"), registry).notes;
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_EQ(notes[0].what, "RayTracer 'image': no node counts LDDE");
}

TEST(Graphs, RunOnTheHostsThatComeWithThem) {
    const Registry registry(standard_nodes());
    for (const char* hosts :
         {"hosts/two.lua", "hosts/spread.lua", "hosts/affinity.lua", "hosts/threads.lua", "hosts/chain.lua"})
        EXPECT_THAT(examine(graph_called("cornell.lua"), registry, load_hosts((graphs / hosts).string())).problems,
                    IsEmpty());
    const Hosts sharded = load_hosts((graphs / "hosts/sharded.lua").string());
    const Examined found = examine(graph_called("paper/figure5.lua"), registry, sharded);
    EXPECT_THAT(found.problems, IsEmpty());
    EXPECT_THAT(shards_of(found.graph, registry, sharded), ElementsAre(Pair("caustics", 2), Pair("global", 2)));
}

// The graph that a hosts file of the paper is for, as its first line says.
std::string graph_for(const std::filesystem::path& hosts) {
    std::ifstream file(hosts);
    std::string dashes, for_word, name;
    file >> dashes >> for_word >> name;
    EXPECT_EQ(dashes + for_word, "--For") << hosts;
    return "paper/" + name.substr(0, name.find(':'));
}

TEST(Graphs, OfThePaperRunOnTheHostsOfItsFiguresAndTables) {
    Registry registry(standard_nodes());
    registry.add(candela_kinds());
    std::map<std::string, std::map<std::string, int>> replicas;
    for (const auto& entry : std::filesystem::directory_iterator(graphs / "paper/hosts")) {
        const Hosts hosts = load_hosts(entry.path().string());
        EXPECT_THAT(examine(graph_called(graph_for(entry.path())), registry, hosts).problems, IsEmpty())
            << entry.path();
        auto& of_file = replicas[entry.path().stem()];
        for (const auto& host : hosts.hosts) {
            of_file["places"] += host.places;
            for (const auto& [node, count] : host.replicas) of_file[node] += count;
        }
    }
    EXPECT_EQ(replicas.size(), 6u) << "figures 3, 5 and 7, and three tables";
    EXPECT_EQ(replicas["table2"]["image"], 8);
    EXPECT_EQ(replicas["table2"]["lighting"], 6);
    EXPECT_EQ(replicas["table2"]["places"], 8);
    EXPECT_EQ(replicas["table3"]["places"], 7);
    EXPECT_EQ(replicas["figure7"]["image"], 3);
}

TEST(Graphs, HaveTheLayersThatTheySay) {
    const Registry registry(standard_nodes());
    EXPECT_THAT(layers_of(check(graph_called("cornell.lua"), registry), registry).film,
                ElementsAre("emission", "direct", "bounce"));
    EXPECT_THAT(layers_of(check(graph_called("weights.lua"), registry), registry).film,
                ElementsAre("emission", "direct", "once", "often", "openness"));
}

}  // namespace
}  // namespace lightnet::graphs_test
