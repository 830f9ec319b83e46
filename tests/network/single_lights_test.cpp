// What light of a node hangs on, and what is left out of a graph whose lights are there.
#include "core/network/graph/single_lights.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/network/graph/plan.hpp"
#include "tests/support/parse.hpp"

namespace lightnet::single_lights_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

// Kinds without algorithms, whose renderer says what its questions hang on.
Registry kinds() {
    Kind renderer = test::ray_tracer();
    renderer.asks_by = reading(ScenePart::camera);
    Kind rehearsed = test::cache();
    rehearsed.name = "Rehearsed";
    rehearsed.run.rehearses = true;
    return Registry({renderer, rehearsed, test::ambient(), test::combine(), test::cache(), test::reuse()});
}

Graph graph_of(const std::string& nodes, const std::string& more = "") {
    return check(test::parse(nodes +
                             "scene = Scene { 'box.pbrt' }\n"
                             "image = RayTracer { lighting, " +
                             more + "scene = scene, film = { 8, 4 } }"),
                 kinds());
}

std::vector<std::string> names_of(const std::vector<SingleLight>& lights, const Graph& graph) {
    std::vector<std::string> names;
    for (const auto& light : lights) names.push_back(graph.nodes[light.node].name);
    return names;
}

std::string text_of(const std::string& node, const Graph& graph) {
    for (const auto& light : single_lights(graph, kinds()))
        if (graph.nodes[light.node].name == node) return light.text;
    return "";
}

// What of the kinds of this graph is left out, where the light of those nodes is there.
std::vector<std::string> left_out(const Graph& graph, const std::vector<std::string>& there) {
    auto lights = single_lights(graph, kinds());
    std::erase_if(lights, [&](const SingleLight& light) {
        return std::find(there.begin(), there.end(), graph.nodes[light.node].name) == there.end();
    });
    const Graph rest = without_lights(graph, kinds(), lights);
    EXPECT_EQ(layers_of(rest, kinds()).film, layers_of(graph, kinds()).film);
    check(rest, kinds());
    std::vector<std::string> names;
    for (const auto& node : rest.nodes)
        if (node.kind == left_out_kind) names.push_back(node.name);
    EXPECT_EQ(names, names_of(lights, graph));
    return names;
}

TEST(SingleLights, AreThoseOfAllTerminals) {
    const Graph graph = graph_of("a = Ambient {} b = Ambient {} c = Cache { a } lighting = Combine { c, b }");
    EXPECT_THAT(names_of(single_lights(graph, kinds()), graph), ElementsAre("b", "c"));
}

TEST(SingleLights, HangOnNothingOfOthers) {
    const Graph one = graph_of("a = Ambient {} b = Ambient {} lighting = Combine { a, b, weights = { 2, 1 } }");
    const Graph two = graph_of(
        "a = Ambient {} c = Ambient {} b = Ambient { rays = 8 } lighting = Combine { c, a, b, weights = { 7, 2, 5 } }");
    EXPECT_EQ(text_of("a", one), text_of("a", two));
    EXPECT_NE(text_of("b", one), text_of("b", two));
}

TEST(SingleLights, HangOnWhatTheyAskAndWhatPassesThemOn) {
    const std::string usual = text_of("c", graph_of("a = Ambient {} c = Cache { a } lighting = Combine { c }"));
    EXPECT_NE(usual, "");
    EXPECT_NE(usual, text_of("c", graph_of("a = Ambient { rays = 8 } c = Cache { a } lighting = Combine { c }")));
    EXPECT_NE(usual,
              text_of("c", graph_of("a = Ambient {} c = Cache { a } lighting = Combine { c, weights = { 2 } }")));
}

TEST(SingleLights, AreNoneWhereARehearsalNotesQuestionsOfAll) {
    const Graph graph = graph_of("a = Ambient {} c = Rehearsed { a } lighting = Combine { c, a }");
    EXPECT_THAT(single_lights(graph, kinds()), IsEmpty());
}

TEST(SingleLights, AreNoneWhereTheRendererSaysNothing) {
    const Graph graph = test::sound_graph("a = Ambient {} b = Ambient {} lighting = Combine { a, b }");
    EXPECT_THAT(single_lights(graph, test::fake_registry()), IsEmpty());
}

TEST(LightsLeftOut, AreThoseThatNobodyElseAsks) {
    const Graph graph = graph_of("a = Ambient {} b = Ambient {} c = Cache { a } lighting = Combine { a, b, c }");
    EXPECT_THAT(left_out(graph, {"a", "b"}), ElementsAre("b")) << "c asks a";
    EXPECT_THAT(left_out(graph, {"a", "c"}), ElementsAre("a", "c")) << "nobody asks c, so c asks nobody";
}

TEST(LightsLeftOut, AreNotShownNorTaken) {
    const Graph shown =
        graph_of("a = Ambient {} b = Ambient {} c = Cache { a } lighting = Combine { a, b }", "show = { c }, ");
    EXPECT_THAT(left_out(shown, {"a", "b"}), ElementsAre("b"));
    const Graph taken = graph_of("a = Ambient {} c = Cache { a } d = Reuse { of = c } lighting = Combine { c, d }");
    EXPECT_THAT(left_out(taken, {"c"}), IsEmpty()) << "d takes what c keeps";
}

TEST(LightsLeftOut, AreNotThoseOfASumThatIsGathered) {
    const Graph graph = graph_of(
        "a = Ambient {} b = Ambient {} sum = Combine { a, b } c = Cache { sum } lighting = Combine { sum, c }");
    EXPECT_THAT(left_out(graph, {"a", "b"}), IsEmpty());
    EXPECT_THAT(left_out(graph, {"a", "b", "c"}), ElementsAre("a", "b", "c"));
}

}  // namespace
}  // namespace lightnet::single_lights_test
