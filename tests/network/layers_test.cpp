#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/network/graph/plan.hpp"
#include "tests/support/parse.hpp"

namespace lightnet::layers_test {
namespace {

using test::fake_registry;
using test::sound_graph;
using testing::ElementsAre;

TEST(Layers, AreTheTerminalsOfAdditivePathsInGraphOrder) {
    const Graph graph = sound_graph(
        "direct = Ambient {} caustics = Ambient {}\n"
        "first = Combine { caustics, direct }\n"
        "bounce = Cache { first }\n"
        "lighting = Combine { bounce, first }");
    const Layers layers = layers_of(graph, fake_registry());
    EXPECT_THAT(layers.film, ElementsAre("emission", "direct", "caustics", "bounce"));
    const Terminal direct{0}, caustics{1}, bounce{3};
    EXPECT_THAT(layers.of_node, ElementsAre(ElementsAre(direct), ElementsAre(caustics), ElementsAre(direct, caustics),
                                            ElementsAre(bounce), ElementsAre(direct, caustics, bounce), ElementsAre(),
                                            ElementsAre(direct, caustics, bounce)));
}

TEST(Layers, CountANodeOnceHoweverManyWaysLeadToIt) {
    const Graph graph = sound_graph("a = Ambient {} b = Combine { a, a } lighting = Combine { a, b }");
    EXPECT_THAT(layers_of(graph, fake_registry()).film, ElementsAre("emission", "a"));
}

TEST(Layers, LeaveOutWhatANodeKeepsToItself) {
    const Graph graph = sound_graph("a = Ambient {} sum = Combine { a, a } lighting = Cache { sum }");
    const Layers layers = layers_of(graph, fake_registry());
    EXPECT_THAT(layers.film, ElementsAre("emission", "lighting"));
    EXPECT_THAT(layers.of_node[1], ElementsAre(Terminal{1})) << "inside, a sum is one colour";
}

TEST(Layers, HaveWhatIsShownBesideTheSum) {
    const Graph graph =
        check(test::parse("a = Ambient {} b = Ambient {} sum = Combine { a, b } lighting = Cache { sum }\n"
                          "scene = Scene { 'box.pbrt' }\n"
                          "image = RayTracer { lighting, show = { sum, a, sum, lighting }, "
                          "scene = scene, film = { 8, 4 } }"),
              fake_registry());
    const Layers layers = layers_of(graph, fake_registry());
    EXPECT_THAT(layers.film, ElementsAre("emission", "lighting"));
    EXPECT_THAT(shown_names(layers, graph), ElementsAre("sum", "a")) << "each once, and no layer of the sum";
    EXPECT_EQ(colours_of(layers), 4u);
}

}  // namespace
}  // namespace lightnet::layers_test
