// Graphs without measure: refused in words, whoever wrote them, and walked through without the stack.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pthread.h>

#include <chrono>

#include "core/base/processor_time.hpp"
#include "core/network/graph/dot.hpp"
#include "core/network/graph/json.hpp"
#include "core/network/graph/layout.hpp"
#include "core/network/graph/light_paths.hpp"
#include "core/network/graph/plan.hpp"
#include "tests/support/parse.hpp"
#include "tests/support/slowdown.hpp"

namespace lightnet::limits_test {
namespace {

using test::error_of;
using test::fake_registry;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

Node node(const std::string& name, const std::string& kind, List entries = {}) {
    return {name, kind, std::move(entries), {}, {"graph.lua", 1}};
}
Value named(const std::string& name) { return {NodeRef{name}}; }

/// A light, and so many sums above it, each of the one below.
Graph chain(std::size_t sums) {
    Graph graph{"graph.lua", {node("scene", "Scene", {Value{std::string("box.pbrt")}}), node("n0", "Ambient")}};
    for (std::size_t i = 1; i <= sums; ++i)
        graph.nodes.push_back(node("n" + std::to_string(i), "Combine", {named("n" + std::to_string(i - 1))}));
    Node image = node("image", "RayTracer", {named("n" + std::to_string(sums))});
    image.params = {{"scene", named("scene")}, {"film", {Table{{Value{8.0}, Value{4.0}}, {}}}}};
    graph.nodes.push_back(std::move(image));
    return graph;
}

std::string refusal(const Graph& graph) {
    return error_of([&] { check(graph, fake_registry()); });
}

/// Runs it with as little stack as a thread may reasonably have.
void with_little_stack(void (*act)()) {
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setstacksize(&attributes, std::size_t{256} << 10);
    pthread_t thread{};
    const auto enter = [](void* what) -> void* {
        reinterpret_cast<void (*)()>(what)();
        return nullptr;
    };
    ASSERT_EQ(pthread_create(&thread, &attributes, enter, reinterpret_cast<void*>(act)), 0);
    pthread_join(thread, nullptr);
    pthread_attr_destroy(&attributes);
}

TEST(GraphLimits, RefuseMoreNodesThanAGraphMayHave) {
    EXPECT_EQ(refusal(chain(100'000)), "graph.lua: a graph has at most 4096 nodes, this one has 100003");
}

TEST(GraphLimits, RefuseMoreReferencesThanAGraphMayHave) {
    Graph graph = chain(1);
    graph.nodes[2].entries.assign(most_references + 1, named("n0"));
    EXPECT_THAT(refusal(graph), HasSubstr("at most 16384 places where a node names another, this one has 16387"));
}

TEST(GraphLimits, RefuseNodesThatAskEachOtherInTooLongARow) {
    EXPECT_EQ(refusal(chain(most_rank - 1)), "");
    EXPECT_EQ(refusal(chain(most_rank)),
              "graph.lua:1: RayTracer 'image': too many nodes ask each other in a row below it: at most 64 can");
    EXPECT_THAT(refusal(chain(3000)), HasSubstr("Combine 'n65': too many nodes ask each other in a row"));
}

TEST(GraphLimits, AreFarAboveWhatIsTakenQuickly) {
    Graph graph = chain(0);
    List lights;
    for (std::size_t i = 0; graph.nodes.size() < most_nodes - 1; ++i) {
        graph.nodes.push_back(node("light" + std::to_string(i), "Ambient"));
        lights.push_back(named(graph.nodes.back().name));
    }
    graph.nodes.push_back(node("sum", "Combine", lights));
    graph.nodes[2].entries = {named("sum")};
    const auto begun = thread_processor_time();
    const Examined found = examine(graph, fake_registry());
    EXPECT_TRUE(found.problems.empty());
    EXPECT_EQ(layers_of(found.graph, fake_registry()).film.size(), most_nodes - 3)
        << "emission, and all but four nodes";
    EXPECT_LT(thread_processor_time() - begun, test::slowdown * std::chrono::seconds(5));
}

TEST(LongChains, AreWalkedThroughWithLittleStack) {
    with_little_stack([] {
        const Registry registry = fake_registry();
        const Graph graph = chain(most_nodes - 3);
        EXPECT_EQ(ranks_of(graph).back(), most_nodes - 2);
        EXPECT_EQ(layers_of(graph, registry).film, (std::vector<std::string>{"emission", "n0"}));
        EXPECT_EQ(used_nodes(graph, renderer_of(graph, registry)), std::vector<bool>(most_nodes, true));
        EXPECT_TRUE(fits(plan(graph, registry, {}, {{"tcp://a:1", 1}}), graph));
        EXPECT_THAT(to_dot(graph, registry), HasSubstr("node_n4000 -> node_n3999"));
        EXPECT_EQ(graph_from_json(to_json(graph)), graph);
        EXPECT_TRUE(report_paths(graph, registry).doubles.empty());
    });
}

TEST(LongChains, ThatBiteTheirTailAreToldInShort) {
    Graph graph = chain(3000);
    graph.nodes[1] = node("n0", "Combine", {named("n3000")});
    const auto found = examine(graph, fake_registry());
    ASSERT_THAT(found.problems, SizeIs(1));
    EXPECT_THAT(found.problems[0].what, HasSubstr("asks itself: n0 → n3000 → n2999"));
    EXPECT_LT(found.problems[0].what.size(), 1000u);
}

TEST(Problems, OfAGraphAreToldUpToAHundred) {
    Graph graph = chain(0);
    for (int i = 0; i < 1000; ++i) graph.nodes.push_back(node("x" + std::to_string(i), std::string(5000, 'y')));
    const auto problems = examine(graph, fake_registry()).problems;
    ASSERT_THAT(problems, SizeIs(101));
    EXPECT_EQ(to_string(problems.back()), "and 900 more");
    for (const auto& problem : problems) EXPECT_LT(problem.what.size(), 1000u);
}

TEST(Shards, OfANodeThatIsLargeAreRefused) {
    Graph graph = chain(0);
    graph.nodes[1].params["paths"] = Value{std::string(1 << 20, 'x')};
    EXPECT_NO_THROW(sharded(graph, {{"n0", 100}}));
    EXPECT_THAT(error_of([&] { sharded(graph, {{"n0", 1000}}); }), HasSubstr("too many parameters to be sharded"));
}

TEST(JsonLimits, OfTextsFromElsewhereHold) {
    const auto siblings = [](const std::string& one, std::size_t count) {
        std::string text = "[";
        for (std::size_t i = 0; i < count; ++i) text += one + ",";
        return text + "0]";
    };
    const auto begun = thread_processor_time();
    EXPECT_THAT(error_of([&] { graph_from_json(siblings("{\"\":0}", 400'000)); }), HasSubstr("an object was expected"));
    EXPECT_LT(thread_processor_time() - begun, test::slowdown * std::chrono::seconds(2))
        << "time grows with the square of the siblings";
    EXPECT_THAT(error_of([&] { graph_from_json(siblings("0", 1'100'000)); }), HasSubstr("more than 1000000 values"));
    EXPECT_THAT(error_of([&] { graph_from_json(to_json(chain(5000))); }), HasSubstr("a graph has at most 4096 nodes"));
}

TEST(JsonLimits, KeepWholeNumbersToTheLastBit) {
    const Json json = parse_json("[18446744073709551615, -1, 1.5, 2.0]");
    EXPECT_EQ(json.list(4)[0].whole<std::uint64_t>(), ~std::uint64_t{0});
    EXPECT_THAT(error_of([&] { json.list()[0].whole<std::uint32_t>(); }), HasSubstr("is more than 4294967295"));
    for (const std::size_t other : {1, 2, 3})
        EXPECT_THAT(error_of([&] { json.list()[other].whole<int>(); }), HasSubstr("a whole number from 0 on"));
}

}  // namespace
}  // namespace lightnet::limits_test
