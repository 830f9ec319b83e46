// Edits of a graph, as lines of JSON.
#include "tools/request/graph_edits.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lua/load_graph.hpp"
#include "nodes/standard_nodes.hpp"
#include "tests/support/mistake.hpp"

namespace lightnet::graph_edits_test {
namespace {

using testing::HasSubstr;

class GraphEditsTest : public ::testing::Test {
protected:
    void say(const std::string& line) { take(edit_of(line), edits_); }
    Graph edited() {
        Graph graph = parse_graph(
            "scene = Scene { 'a.pbrt' }\n"
            "light = DirectLighting { samples = 2 }\n"
            "image = RayTracer { light, scene = scene }\n",
            "g.lua");
        apply(edits_, Registry{standard_nodes()}, graph, problems_);
        return graph;
    }

    GraphEdits edits_;
    std::vector<Problem> problems_;
};

std::string mistake_in(const std::string& line) {
    try {
        edit_of(line);
        return "";
    } catch (const Error& error) {
        return error.what();
    }
}

TEST_F(GraphEditsTest, SetParametersOfNodes) {
    say(R"({"set": {"light.samples": 8, "image.film": [64, 48]}})");
    const auto graph = edited();
    EXPECT_EQ(graph.nodes[1].params.at("samples"), Value{8.0});
    EXPECT_EQ(graph.nodes[2].params.at("film"), (Value{Table{{{64.0}, {48.0}}, {}}}));
    EXPECT_TRUE(problems_.empty());
}

TEST_F(GraphEditsTest, ChangeWhatIsSeenAndFromWhere) {
    say(R"({"camera": {"from": [1, 2, 3]}, "scene": "/else/b.glb"})");
    const auto graph = edited();
    EXPECT_EQ(graph.nodes[0].entries, (std::vector<Value>{{std::string("/else/b.glb")}}));
    EXPECT_EQ(graph.nodes[0].params.at("camera"), (Value{Table{{}, {{"from", {Table{{{1.0}, {2.0}, {3.0}}, {}}}}}}}));
}

TEST_F(GraphEditsTest, AreTakenBackByNull) {
    const auto before = edited();
    say(R"({"set": {"light.samples": 8}, "camera": {"fov": 20}, "scene": "b.glb", "constants": {"n": 1}})");
    EXPECT_NE(edited(), before);
    say(R"({"set": {"light.samples": null}, "camera": null, "scene": null, "constants": {"n": null}})");
    EXPECT_EQ(edited(), before);
    EXPECT_TRUE(edits_.constants.empty());
}

TEST_F(GraphEditsTest, GiveConstantsAsTheCommandLineDoes) {
    say(R"({"constants": {"rays": 64, "file": "a b.exr", "on": true, "share": 0.125}})");
    EXPECT_EQ(edits_.constants, (std::map<std::string, std::string>{
                                    {"rays", "64"}, {"file", "a b.exr"}, {"on", "true"}, {"share", "0.125"}}));
}

TEST_F(GraphEditsTest, SayWhatIsWrongWithALine) {
    EXPECT_THAT(mistake_in("{"), HasSubstr("malformed JSON"));
    EXPECT_THAT(mistake_in("[1]"), HasSubstr("malformed JSON"));
    EXPECT_THAT(mistake_in(R"({"cmaera": {}})"), HasSubstr("no member 'cmaera' (did you mean 'camera'?)"));
    EXPECT_THAT(mistake_in(R"({"set": 3})"), HasSubstr("'set': "));
    EXPECT_THAT(mistake_in(R"({"constants": {"a": [1]}})"), HasSubstr("constant 'a' must be a number or a text"));
    EXPECT_THAT(mistake_in(R"({"end": "yes"})"), HasSubstr("'end': "));
}

TEST_F(GraphEditsTest, KeepTheirIdsWhateverIsWrongWithThem) {
    EXPECT_EQ(id_of(R"({"id": 7, "cmaera": {}})"), "7");
    EXPECT_EQ(id_of(R"({"id": {"a": "b"}, "set": 3})"), R"({"a":"b"})");
    EXPECT_EQ(id_of("no JSON"), "");
    EXPECT_EQ(id_of("[7]"), "");
}

TEST_F(GraphEditsTest, NameNodesThatAreNotThere) {
    say(R"({"set": {"lihgt.samples": 8, "samples": 3, "light.": 2}})");
    edited();
    ASSERT_EQ(problems_.size(), 3u);
    std::string all;
    for (const auto& problem : problems_) all += problem.what + "\n";
    EXPECT_THAT(all, HasSubstr("there is no node 'lihgt' (did you mean 'light'?)"));
    EXPECT_THAT(all, HasSubstr("node.parameter, not 'samples'"));
}

}  // namespace
}  // namespace lightnet::graph_edits_test
