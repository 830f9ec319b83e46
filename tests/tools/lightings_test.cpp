// Lightings that have names are the networks of the graph files of these names.
#include "tools/cli/lightings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "core/network/graph/check.hpp"
#include "core/network/graph/graph_film.hpp"
#include "lua/load_graph.hpp"
#include "nodes/standard_nodes.hpp"
#include "tools/cli/render.hpp"

namespace lightnet::lightings_test {
namespace {

using testing::IsEmpty;

const std::filesystem::path graphs = std::filesystem::path(LIGHTNET_SOURCE_DIR) / "graphs";

std::map<std::string, std::string> size_constants(const char* samples) {
    return {{"width", "320"}, {"height", "200"}, {"samples", samples}};
}

// With all defaults, the scene and the lines of files left out.
std::vector<Node> operators(const Graph& graph, const Registry& registry) {
    auto examined = examine(graph, registry);
    EXPECT_THAT(examined.problems, IsEmpty());
    std::vector<Node> nodes;
    for (Node& node : examined.graph.nodes) {
        if (node.kind == "Scene" || node.kind == "RayTracer") continue;
        node.where = {};
        nodes.push_back(std::move(node));
    }
    std::sort(nodes.begin(), nodes.end(), [](const Node& a, const Node& b) { return a.name < b.name; });
    return nodes;
}

Graph named_graph(const std::string& name) {
    RenderedScene scene;
    scene.file = (graphs / "cornell_box.pbrt").string();
    scene.lighting = name;
    return render_graph(scene).graph;
}

class LightingOf : public testing::TestWithParam<Lighting> {};

TEST_P(LightingOf, ThatNameIsTheGraphFiles) {
    const Registry registry(standard_nodes());
    const Lighting& lighting = GetParam();
    auto graph = named_graph(lighting.name);
    settle_lighting(graph, 320 * 200, 64);
    const auto shipped = load_graph((graphs / lighting.graph).string(), {.constants = [&] {
                                        auto constants = size_constants("64");
                                        return constants;
                                    }()});
    auto own = operators(graph, registry), other = operators(shipped, registry);
    // What the three older names add up is called otherwise.
    for (auto* nodes : {&own, &other})
        for (Node& node : *nodes)
            if (node.kind == "Combine" && (node.name == "light" || lighting.name == "path")) node.name = "lighting";
    std::sort(own.begin(), own.end(), [](const Node& a, const Node& b) { return a.name < b.name; });
    std::sort(other.begin(), other.end(), [](const Node& a, const Node& b) { return a.name < b.name; });
    EXPECT_EQ(own, other) << lighting.name;
}

std::vector<Lighting> with_files() {
    std::vector<Lighting> all;
    for (const auto& lighting : lightings())
        if (!lighting.graph.empty()) all.push_back(lighting);
    return all;
}

INSTANTIATE_TEST_SUITE_P(Lightings, LightingOf, testing::ValuesIn(with_files()),
                         [](const auto& tested) { return tested.param.name; });

TEST(Lightings, BeginTheirTrialsWithOneThatHasNoBias) {
    const auto first = std::find_if(lightings().begin(), lightings().end(), [](const auto& l) { return l.on_trial; });
    ASSERT_NE(first, lightings().end());
    EXPECT_FALSE(first->is_biased);
    EXPECT_EQ(first->name, "path_all");
}

TEST(Lightings, LearnFromMorePathsForLargerPictures) {
    EXPECT_EQ(lessons_of(64 * 64, 4), 60000) << "the least";
    EXPECT_EQ(lessons_of(512 * 512, 64), 512 * 512 * 64 / 6);
    Graph graph = named_graph("guided");
    settle_lighting(graph, std::uint64_t{16384} * 16384, 1 << 20);
    EXPECT_THAT(examine(graph, Registry(standard_nodes())).problems, IsEmpty()) << "no more than the kind takes";
}

}  // namespace
}  // namespace lightnet::lightings_test
