#include "lua/load_graph.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/folder.hpp"
#include "tests/support/parse.hpp"

namespace lightnet::load_graph_test {
namespace {

using test::error_of;
using test::Folder;
using test::parse;
using testing::ElementsAre;
using testing::HasSubstr;

std::string error_in(const std::string& text) {
    return error_of([&] { parse(text); });
}

std::vector<std::string> names_in(const Graph& graph) {
    std::vector<std::string> names;
    for (const auto& node : graph.nodes) names.push_back(node.name);
    return names;
}

TEST(LoadGraph, MakesANodeOfEachConstructor) {
    const Graph graph = parse(
        "sky = Ambient { rays = 4, soft = true, paths = 'all' }\n"
        "sum = Combine { sky, sky, weights = { 0.5, 2 } }");
    const Node sky{
        "sky", "Ambient", {}, {{"rays", {4.0}}, {"soft", {true}}, {"paths", {std::string("all")}}}, {"graph.lua", 1}};
    const Node sum{"sum",
                   "Combine",
                   {{NodeRef{"sky"}}, {NodeRef{"sky"}}},
                   {{"weights", {Table{{{0.5}, {2.0}}, {}}}}},
                   {"graph.lua", 2}};
    EXPECT_EQ(graph, (Graph{"graph.lua", {sky, sum}}));
}

TEST(LoadGraph, KeepsTheOrderOfNames) {
    EXPECT_THAT(names_in(parse("local last = function() return Ambient {} end\nb = Ambient {}\na = last()\n")),
                ElementsAre("b", "a"));
}

TEST(LoadGraph, LetsAnInputBeNamedFurtherDown) {
    const Graph graph = parse("sum = Combine { sky }\nsky = Ambient {}");
    EXPECT_EQ(graph.nodes[0].entries, (List{{NodeRef{"sky"}}}));
}

TEST(LoadGraph, LetsANodeHaveASecondName) {
    const Graph graph = parse("sum = Combine { light }\nsky = Ambient {}\nlight = sky\nother = Combine { light }");
    EXPECT_THAT(names_in(graph), ElementsAre("sum", "sky", "other"));
    EXPECT_EQ(graph.nodes[0].entries, graph.nodes[2].entries);
    EXPECT_EQ(graph.nodes[0].entries, (List{{NodeRef{"sky"}}}));
}

TEST(LoadGraph, TellsTheLineOfEachNode) {
    const Graph graph = parse("\nsky = Ambient {\n  rays = 4,\n}\n\nsum =\n  Combine { sky }");
    EXPECT_EQ(graph.nodes[0].where.line, 2);
    EXPECT_EQ(graph.nodes[1].where.line, 7);
}

TEST(LoadGraph, TakesAnyKindForLaterChecks) { EXPECT_EQ(parse("x = Whatever {}").nodes[0].kind, "Whatever"); }

TEST(LoadGraph, ComputesWithConstants) {
    const Graph graph = parse("n = 3\nfor i = 1, n do _ENV['sky' .. i] = Ambient { rays = i * n } end");
    EXPECT_THAT(names_in(graph), ElementsAre("sky1", "sky2", "sky3"));
    EXPECT_EQ(graph.nodes[2].params.at("rays"), Value{9.0});
}

TEST(LoadGraph, GivesTheSameGraphEachTime) {
    const std::string text =
        "for name, rays in pairs { e = 5, d = 4, c = 3, b = 2, a = 1, [2] = 7, [1] = 9 } do\n"
        "  _ENV['n' .. name] = Ambient { rays = rays + math.random(100) }\nend";
    const Graph first = parse(text);
    EXPECT_THAT(names_in(first), ElementsAre("n1", "n2", "na", "nb", "nc", "nd", "ne"));
    for (int i = 0; i < 5; ++i) EXPECT_EQ(parse(text), first);
}

TEST(LoadGraph, WantsANameForEachNode) {
    EXPECT_EQ(error_in("\nlocal sky = Ambient {}"),
              "graph.lua:2: Ambient: the node has no name; write name = Ambient { … }, without local and not inside "
              "another table");
    EXPECT_THAT(error_in("sum = Combine { Ambient {} }"), HasSubstr("graph.lua:1: Ambient: the node has no name"));
    EXPECT_THAT(error_in("all = { sky = Ambient {} }"), HasSubstr("graph.lua:1: Ambient: the node has no name"));
}

TEST(LoadGraph, NamesWhatNobodyGives) {
    EXPECT_EQ(error_in("rays = 4\nif ryas then end"), "graph.lua:2: nothing is called 'ryas' (did you mean 'rays'?)");
    EXPECT_EQ(error_in("if rays then end\nrays = 4"), "graph.lua:1: 'rays' is used before it has a value");
    EXPECT_EQ(error_in("x = rays * 2"), "graph.lua:1: attempt to perform arithmetic on a nil value (global 'rays')");
    EXPECT_EQ(error_in("x = lib.rays"), "graph.lua:1: attempt to index a nil value (global 'lib')");
    EXPECT_EQ(error_in("\nprin('x')"), "graph.lua:2: there is no function called 'prin'");
}

TEST(LoadGraph, WantsOneTableForANode) {
    EXPECT_THAT(error_in("sky = Ambient(4)"),
                HasSubstr("graph.lua:1: Ambient: takes one table: Ambient { inputs, key = value }"));
}

TEST(LoadGraph, WantsValuesThatCanStandInAGraph) {
    EXPECT_THAT(error_in("sky = Ambient { rays = function() end }"),
                HasSubstr("graph.lua:1: Ambient 'sky': parameter 'rays' is a function"));
    EXPECT_THAT(error_in("sky = Ambient { print }"), HasSubstr("Ambient 'sky': entry 1 is a function"));
    EXPECT_THAT(error_in("sky = Ambient { ['\\xff'] = 1 }"), HasSubstr("is not a text in UTF-8"));
    EXPECT_THAT(error_in("sky = Ambient { [true] = 1 }"), HasSubstr("a parameter goes by a name"));
    EXPECT_THAT(error_in("local t = {} t.t = t\nsky = Ambient { x = t }"),
                HasSubstr("has tables in tables without end"));
    EXPECT_THAT(error_in("a = Ambient {}\nsum = Combine { a, nil, a }"), HasSubstr("nil"));
}

TEST(LoadGraph, TellsAllProblemsAtOnce) {
    const std::string all = error_in("local a = Ambient {}\nb = Ambient { x = print }\nlocal c = nothing");
    EXPECT_THAT(all, HasSubstr("graph.lua:1: "));
    EXPECT_THAT(all, HasSubstr("graph.lua:2: "));
    EXPECT_THAT(all, HasSubstr("graph.lua:3: "));
}

TEST(LoadGraph, TellsTheLineOfAnError) {
    EXPECT_THAT(error_in("\nx = = 2"), HasSubstr("graph.lua:2: unexpected symbol near '='"));
    EXPECT_EQ(error_in("\n\nerror('no')"), "graph.lua:3: no");
    EXPECT_EQ(error_in("\nerror { 1 }"), "graph.lua:2: an error of type table");
    EXPECT_EQ(error_in("local function f(x)\n  error('bad ' .. x, 2)\nend\nf('x')"), "graph.lua:4: bad x");
}

TEST(LoadGraph, TellsTheLineOfAnErrorInAFileWithALongName) {
    const std::string file = std::string(200, 'x') + "/graph.lua";
    EXPECT_EQ(error_of([&] { parse_graph("\nx = = 2", file); }), file + ":2: unexpected symbol near '='");
    EXPECT_EQ(error_of([&] { parse_graph("\nerror('no')", file); }), file + ":2: no");
}

TEST(LoadGraph, NamesTheFileThatIsNotThere) {
    EXPECT_EQ(error_of([] { load_graph("nowhere.lua"); }), "nowhere.lua: No such file or directory");
    EXPECT_EQ(error_of([] { load_graph("/"); }), "/: not a plain file");
}

TEST(LoadGraph, ReadsAFileFromTheDisk) {
    const Folder folder;
    const std::string file = folder.write("g.lua", "sky = Ambient {}");
    EXPECT_EQ(load_graph(file).file, file);
    EXPECT_THAT(names_in(load_graph(file)), ElementsAre("sky"));
}

TEST(Require, ReachesFilesBesideTheGraph) {
    const Folder folder;
    folder.write("parts/sky.lua", "\nsky = Ambient { rays = ... and 1 or 2 }\nreturn { rays = 7 }");
    const std::string file = folder.write(
        "g.lua",
        "local part = require 'parts.sky'\nassert(part == require 'parts.sky')\nsum = Ambient { rays = part.rays }");
    const Graph graph = load_graph(file);
    EXPECT_THAT(names_in(graph), ElementsAre("sky", "sum"));
    EXPECT_EQ(graph.nodes[0].where, (SourceLine{folder.file("parts/sky.lua"), 2}));
    EXPECT_EQ(graph.nodes[1].params.at("rays"), Value{7.0});
}

TEST(Require, TellsTheLineInTheRequiredFile) {
    const Folder folder;
    folder.write("bad.lua", "\n\nx = =");
    const std::string file = folder.write("g.lua", "require 'bad'");
    EXPECT_THAT(error_of([&] { load_graph(file); }), HasSubstr(folder.file("bad.lua") + ":3: unexpected symbol"));
}

TEST(ReadGraphText, TakesAGraphInJsonWithTheLinesOfItsMaker) {
    Graph graph = parse("sky = Ambient { rays = 4 }");
    graph.file = "notebook.py";
    graph.nodes[0].where = {"notebook.py", 17};
    const auto read = read_graph_text("\n " + to_json(graph), standard_input_name);
    EXPECT_EQ(read.graph, graph);
    EXPECT_TRUE(read.problems.empty());
}

TEST(ReadGraphText, IsWhatFilesOfJsonGoThrough) {
    const Folder folder;
    const Graph graph = parse("sky = Ambient { rays = 4 }");
    EXPECT_EQ(read_graph(folder.write("graph.json", to_json(graph))).graph, graph);
    EXPECT_THAT(error_of([&] { read_graph(folder.file("none.json")); }), HasSubstr("none.json: No such file"));
}

TEST(ReadGraphText, HoldsNamesInJsonToThoseOfLua) {
    Graph graph = parse("sky = Ambient {}\nsum = Combine { sky }\nother = Ambient {}");
    graph.nodes[1].name = "sky";
    graph.nodes[2].name = "my sky";
    const auto problems = read_graph_text(to_json(graph), standard_input_name).problems;
    ASSERT_EQ(problems.size(), 2u);
    EXPECT_EQ(to_string(problems[0]), "graph.lua:2: Combine 'sky': another node has this name");
    EXPECT_EQ(to_string(problems[1]), "graph.lua:3: Ambient 'my sky': a name is made of letters, digits and _");
}

TEST(ReadGraphText, SaysWhatIsWrongWithJson) {
    const auto error = [](const std::string& text, const LuaOptions& options = {}) {
        return error_of([&] { read_graph_text(text, standard_input_name, options); });
    };
    EXPECT_THAT(error("{ \"file\": 3"), HasSubstr("<stdin>: "));
    EXPECT_THAT(error("{ \"nodes\": [] }"), HasSubstr("<stdin>: "));
    EXPECT_THAT(error("{}", {.constants = {{"rays", "4"}}}), HasSubstr("-D rays changes nothing in it"));
    EXPECT_THAT(error("{}", {.frame = {.asked = true}}), HasSubstr("--frames takes one in Lua"));
}

TEST(Require, ReachesNothingElse) {
    const Folder outside, folder;
    outside.write("secret.lua", "return 1");
    std::filesystem::create_symlink(outside.path(), folder.path() / "link");
    std::filesystem::create_symlink(outside.file("secret.lua"), folder.path() / "file.lua");
    const std::string absolute = outside.file("secret");
    for (const std::string& name : {std::string("link.secret"), std::string("file"), absolute}) {
        const std::string file = folder.write("g.lua", "require '" + name + "'");
        EXPECT_THAT(error_of([&] { load_graph(file); }), HasSubstr(file + ":1: require \"" + name + "\": ")) << name;
    }
    const std::string file = folder.write("g.lua", "require 'link.secret'");
    EXPECT_THAT(error_of([&] { load_graph(file); }), HasSubstr("lies outside of the graph's folder"));
}

TEST(Require, FindsCircles) {
    const Folder folder;
    folder.write("a.lua", "require 'b'");
    folder.write("b.lua", "require 'a'");
    const std::string file = folder.write("g.lua", "require 'a'");
    EXPECT_THAT(error_of([&] { load_graph(file); }),
                HasSubstr(folder.file("b.lua") + ":1: require \"a\": it requires itself"));
}

}  // namespace
}  // namespace lightnet::load_graph_test
