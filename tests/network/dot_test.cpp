#include "core/network/graph/dot.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "core/network/graph/check.hpp"
#include "core/network/graph/dot_moves.hpp"
#include "lua/load_graph.hpp"
#include "nodes/standard_nodes.hpp"
#include "tests/support/parse.hpp"

namespace lightnet::dot_test {
namespace {

using test::fake_registry;
using test::sound_graph;
using testing::HasSubstr;
using testing::Not;

// Runs `dot` over a text, and tells its exit status.
int status_of_dot(const std::string& text) {
    FILE* const dot = ::popen("/usr/bin/dot -Tsvg > /dev/null", "w");
    std::fwrite(text.data(), 1, text.size(), dot);
    return ::pclose(dot);
}

Graph two_lights() { return sound_graph("a = Ambient {} b = Ambient {} lighting = Combine { a, b }"); }

std::string dot_with(const std::string& hosts, const std::vector<HostOffer>& offers) {
    const Graph graph = two_lights();
    const Plan where = plan(graph, fake_registry(), parse_hosts(hosts, "hosts.lua"), offers);
    return to_dot(graph, fake_registry(), &where);
}

std::string dot_of_two_hosts() {
    return dot_with("place 'tcp://x:1' { a = 2, lighting = 1 }\nplace 'tcp://y:1' { a = 1, b = 1, image = 2 }",
                    {{"tcp://x:1", 1}, {"tcp://y:1", 1}});
}

TEST(Dot, DrawsAGraph) {
    EXPECT_EQ(to_dot(two_lights(), fake_registry()), R"dot(digraph lightnet {
  rankdir=LR;
  node [shape=box, style=rounded, fontname="Helvetica"];
  edge [fontname="Helvetica", fontsize=10];
  launcher [shape=cds, label="launcher"];
  node_a [label="a\nAmbient"];
  node_b [label="b\nAmbient"];
  node_lighting [label="lighting\nCombine"];
  node_scene [shape=note, label="scene\nbox.pbrt"];
  node_image [label="image\nRayTracer", penwidth=2];
  launcher -> node_image [label="Tile → Pixels\ncall"];
  node_lighting -> node_a [label="Query → Rgb\ncall"];
  node_lighting -> node_b [label="Query → Rgb\ncall"];
  node_image -> node_lighting [label="Query → 2 × Rgb\ncall"];
  node_image -> node_scene [label="scene", style=dashed];
}
)dot");
}

TEST(Dot, DrawsAPlan) {
    EXPECT_EQ(dot_with("place 'tcp://x:1' { a = 1, lighting = 1 }\nplace 'tcp://y:1' { a = 1, b = 1, image = 1 }",
                       {{"tcp://x:1", 1}, {"tcp://y:1", 1}}),
              R"dot(digraph lightnet {
  rankdir=LR;
  node [shape=box, style=rounded, fontname="Helvetica"];
  edge [fontname="Helvetica", fontsize=10];
  launcher [shape=cds, label="launcher"];
  subgraph cluster_host_0 {
    label="tcp://x:1"; style=filled; color=lightgrey;
    subgraph cluster_place_0 {
      label="place 0"; style="filled,rounded"; color=white;
      node_a_0 [label="a\nAmbient"];
      node_lighting_0 [label="lighting\nCombine"];
    }
  }
  subgraph cluster_host_1 {
    label="tcp://y:1"; style=filled; color=lightgrey;
    subgraph cluster_place_1 {
      label="place 0"; style="filled,rounded"; color=white;
      node_a_1 [label="a\nAmbient"];
      node_b_1 [label="b\nAmbient"];
      node_image_1 [label="image\nRayTracer", penwidth=2];
    }
  }
  launcher -> node_image_1 [label="Tile → Pixels\ntcp"];
  node_lighting_0 -> node_a_0 [label="Query → Rgb\ncall"];
  node_lighting_0 -> node_b_1 [label="Query → Rgb\ntcp bundles"];
  node_a_0 -> node_a_1 [label="Query → Rgb\ntcp bundles, when busy"];
  node_image_1 -> node_lighting_0 [label="Query → 2 × Rgb\ntcp bundles"];
}
)dot");
}

TEST(Dot, ShowsMultiplexersWhereAnAskerHasAChoice) {
    const std::string dot = dot_with(
        "place 'tcp://w:1' { lighting = 1, image = 1, places = 1 }\nplace 'tcp://x:1' { a = 1, image = 1, "
        "places = 1 }\nplace 'tcp://y:1' { a = 1, b = 1, image = 1, places = 1 }",
        {{"tcp://w:1", 1}, {"tcp://x:1", 1}, {"tcp://y:1", 1}});
    EXPECT_THAT(dot, HasSubstr("choose_image [shape=trapezium, style=solid, label=\"image × 3\"];"));
    EXPECT_THAT(dot, HasSubstr("launcher -> choose_image [label=\"Tile → Pixels\\ncall\"];"));
    EXPECT_THAT(dot, HasSubstr("choose_image -> node_image_1 [label=\"Tile → Pixels\\ntcp\"];"));
    EXPECT_THAT(dot, HasSubstr("node_lighting_0 -> choose_a_0 [label=\"Query → Rgb\\ncall\"];"));
    EXPECT_THAT(dot, HasSubstr("choose_a_0 -> node_a_1 [label=\"Query → Rgb\\ntcp bundles\"];"));
    EXPECT_THAT(dot, Not(HasSubstr("deal_")));
}

TEST(Dot, ShowsThatAHostChoosesAmongItsPlaces) {
    const std::string dot =
        dot_with("place 'tcp://x:1' { a = 2, b = 1 }\nplace 'tcp://y:1' { lighting = 1, image = 2 }",
                 {{"tcp://x:1", 1}, {"tcp://y:1", 1}});
    EXPECT_THAT(dot, HasSubstr("    deal_a_0 [shape=trapezium, style=solid, label=\"a × 2\"];\n  }"))
        << "in its host, beside its places";
    EXPECT_THAT(dot, HasSubstr("node_lighting_2 -> deal_a_0 [label=\"Query → Rgb\\ntcp bundles\"];"));
    EXPECT_THAT(dot, HasSubstr("deal_a_0 -> node_a_1 [label=\"Query → Rgb\\ninproc bundles\"];"));
    EXPECT_THAT(dot, HasSubstr("launcher -> deal_image_2 [label=\"Tile → Pixels\\ntcp\"];"));
    EXPECT_THAT(dot, HasSubstr("deal_image_2 -> node_image_3 [label=\"Tile → Pixels\\ninproc\"];"));
    EXPECT_THAT(dot, HasSubstr("node_image_3 -> node_lighting_2 [label=\"Query → 2 × Rgb\\ninproc bundles\"];"));
    EXPECT_THAT(dot, Not(HasSubstr("choose_"))) << "there is but one host to ask";
}

TEST(Dot, ShowsWhoRelievesWhom) {
    const std::string dot =
        dot_with("place 'tcp://x:1' { a = 1, b = 1, lighting = 1, image = 1, places = 1 }\nplace 'tcp://y:1' { a = 1 }",
                 {{"tcp://x:1", 1}, {"tcp://y:1", 1}});
    EXPECT_THAT(dot, HasSubstr("node_lighting_0 -> node_a_0 [label=\"Query → Rgb\\ncall\"];"));
    EXPECT_THAT(dot, HasSubstr("node_a_0 -> node_a_1 [label=\"Query → Rgb\\ntcp bundles, when busy\"];"));
    EXPECT_THAT(dot, Not(HasSubstr("node_a_1 -> "))) << "who holds less is relieved by nobody";
}

// Every box but those of renderers, whom the launcher asks, is asked by somebody: in all layouts that we ship.
TEST(Dot, LeavesNoReplicaWithoutAnArrow) {
    const std::string folder = LIGHTNET_SOURCE_DIR "/graphs/paper/";
    for (const auto& [graph, hosts] : std::vector<std::pair<std::string, std::string>>{{"figure3", "figure3"},
                                                                                       {"figure5", "figure5"},
                                                                                       {"figure5", "figure7"},
                                                                                       {"figure5", "table2"},
                                                                                       {"figure5", "table3"}}) {
        const Hosts file = load_hosts(folder + "hosts/" + hosts + ".lua");
        const Registry registry(standard_nodes());
        const Graph checked = check(load_graph(folder + graph + ".lua"), registry);
        std::vector<HostOffer> offers;
        for (const auto& host : file.hosts)
            if (std::none_of(offers.begin(), offers.end(),
                             [&](const auto& one) { return one.endpoint == host.host(); }))
                offers.push_back({host.host(), static_cast<std::uint32_t>(std::max(host.places, 1))});
        const Plan where = plan(checked, registry, file, offers);
        const std::string dot = to_dot(checked, registry, &where, {}, {});
        for (std::size_t node = 0; node < checked.nodes.size(); ++node)
            for (const auto place : where.places_of[node]) {
                const auto box = "node_" + checked.nodes[node].name + "_" + std::to_string(place);
                EXPECT_THAT(dot, HasSubstr("-> " + box + " [")) << hosts << ": nobody asks " << box;
            }
    }
}

TEST(Dot, ShowsPlacesOfThisProcessAndWhatTheyAskEachOther) {
    const std::string dot = dot_with(
        "place 'here' { a = 2 }\nplace 'tcp://x:1' { b = 1 }\nplace 'here' { lighting = 1, image = 1, places = 1 }",
        {{"", 1}, {"tcp://x:1", 1}});
    EXPECT_THAT(dot, HasSubstr("label=\"this process\""));
    EXPECT_THAT(dot, HasSubstr("cluster_host_1"));
    EXPECT_THAT(dot, Not(HasSubstr("cluster_host_2"))) << "its entries are one host";
    EXPECT_THAT(dot, HasSubstr("launcher -> node_image_2 [label=\"Tile → Pixels\\ninproc\"];"));
    EXPECT_THAT(dot, HasSubstr("choose_a_2 -> node_a_1 [label=\"Query → Rgb\\ninproc bundles\"];"));
    EXPECT_THAT(dot, HasSubstr("node_lighting_2 -> node_b_3 [label=\"Query → Rgb\\ntcp bundles\"];"));
}

TEST(Dot, ShowsOnePlaceNextToTheOther) {
    const Plan where = plan(two_lights(), fake_registry(), {}, {{"", 2}});
    const std::string dot = to_dot(two_lights(), fake_registry(), &where, {{"", "here \"and\\now\""}});
    EXPECT_THAT(dot, HasSubstr("label=\"here \\\"and\\\\now\\\"\""));
    EXPECT_THAT(dot, HasSubstr("choose_image -> node_image_1 [label=\"Tile → Pixels\\ninproc\"];"));
    EXPECT_THAT(dot, HasSubstr("node_image_1 -> node_lighting_1 [label=\"Query → 2 × Rgb\\ncall\"];"));
    EXPECT_THAT(dot, Not(HasSubstr("choose_lighting")));
}

// `a` was at y, and is at x now; the launcher gave `lighting` to y as well.
TEST(Dot, ShowsWhatMovedAndWhere) {
    const Graph graph = two_lights();
    const Plan where = plan(
        graph, fake_registry(),
        parse_hosts("place 'x' { a = 1, b = 1, lighting = 1 }\nplace 'y' { lighting = 1, image = 1 }", "hosts.lua"),
        {{"x", 1}, {"y", 1}});
    const auto plain = to_dot(graph, fake_registry(), &where);
    const auto text = with_moves(plain, graph, where,
                                 {{"a", {"y"}, {"x"}, 3.14}, {"lighting", {}, {"y"}, 5}, {"b", {"gone"}, {}, 7}});
    EXPECT_THAT(text, HasSubstr("  subgraph cluster_host_1 { left_a_0 [label=\"a\\nuntil 3.1 s\""));
    EXPECT_THAT(text, HasSubstr("  left_a_0 -> node_a_0 [label=\"a moves\\nat 3.1 s\", style=dotted"));
    EXPECT_THAT(text, HasSubstr("  launcher -> node_lighting_1 [label=\"lighting moves\\nat 5.0 s\""));
    EXPECT_THAT(text, HasSubstr("  left_b_1 [label=\"b\\nuntil 7.0 s\"")) << "its host is gone";
    EXPECT_THAT(text, testing::StartsWith(plain.substr(0, plain.size() - 2)));
    EXPECT_EQ(with_moves(plain, graph, where, {}), plain);
    if (std::filesystem::exists("/usr/bin/dot")) {
        EXPECT_EQ(status_of_dot(text), 0);
    }
}

TEST(Dot, IsReadByGraphviz) {
    if (!std::filesystem::exists("/usr/bin/dot")) GTEST_SKIP() << "no Graphviz here";
    Graph odd = two_lights();
    odd.nodes[3].entries[0] = {std::string("a \"quoted\"\\path\nwith <b>odd</b> signs.pbrt")};
    EXPECT_EQ(status_of_dot(to_dot(odd, fake_registry())), 0);
    EXPECT_EQ(status_of_dot(dot_of_two_hosts()), 0);
}

TEST(Dot, ShowsPicturesInTheirBoxes) {
    const std::string text = to_dot(two_lights(), fake_registry(), nullptr, {}, {{"a", "x.a.png"}});
    EXPECT_THAT(text, HasSubstr("node_a [label=<<TABLE BORDER=\"0\"><TR><TD><IMG SRC=\"x.a.png\"/></TD></TR>"
                                "<TR><TD>a<BR/>Ambient</TD></TR></TABLE>>];"));
    EXPECT_THAT(text, HasSubstr("node_b [label=\"b\\nAmbient\"];"));
}

TEST(Dot, DrawsWhatIsTakenAndWhatIsShown) {
    const Graph graph = check(test::parse("a = Ambient {} lighting = Cache { a } again = Reuse { of = lighting }\n"
                                          "scene = Scene { 'box.pbrt' }\n"
                                          "image = RayTracer { lighting, show = { again }, scene = scene, "
                                          "film = { 8, 4 } }"),
                              fake_registry());
    const std::string text = to_dot(graph, fake_registry());
    EXPECT_THAT(text, HasSubstr("node_again -> node_lighting [label=\"records\", style=dashed];"));
    EXPECT_THAT(text, HasSubstr("node_image -> node_again [label=\"Query → Rgb\\ncall\"];"));
    if (!std::filesystem::exists("/usr/bin/dot")) return;
    const Plan where = plan(graph, fake_registry(), {}, {{"", 1}});
    EXPECT_EQ(status_of_dot(to_dot(graph, fake_registry(), &where)), 0);
}

}  // namespace
}  // namespace lightnet::dot_test
