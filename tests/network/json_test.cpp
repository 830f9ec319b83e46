#include "core/network/graph/json.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/network/graph/plan.hpp"
#include "tests/support/parse.hpp"

namespace lightnet::json_test {
namespace {

using test::error_of;
using test::parse;
using testing::HasSubstr;

Graph graph_with(Value value) { return {"g.lua", {{"a", "Ambient", {}, {{"x", std::move(value)}}, {"g.lua", 1}}}}; }

double number_after_a_round_trip(double number) {
    const Graph back = graph_from_json(to_json(graph_with({number})));
    return std::get<double>(back.nodes[0].params.at("x").data);
}

TEST(GraphJson, ComesBackEqual) {
    const Graph graph = parse(
        "a = Ambient { rays = 3, soft = true, paths = 'caus\"tic\\\\ü' }\n"
        "b = Combine { a, a, weights = { 0.1, 2 }, nested = { x = { a, 'y' } } }");
    EXPECT_EQ(graph_from_json(to_json(graph)), graph);
}

TEST(GraphJson, IsTheSameBytesForTheSameGraph) {
    const Graph one = parse("a = Ambient { rays = 3, soft = true }"),
                other = parse("a = Ambient { soft = true, rays = 3 }");
    EXPECT_EQ(to_json(one), to_json(other));
}

TEST(GraphJson, KeepsEveryBitOfANumber) {
    for (const double number : {0.1, -0.0, 1e-310, 1.7976931348623157e308, 9007199254740993.0, 1.0 / 3})
        EXPECT_EQ(number_after_a_round_trip(number), number);
    EXPECT_TRUE(std::signbit(number_after_a_round_trip(-0.0)));
}

TEST(GraphJson, KeepsNumbersThatAreNotFinite) {
    EXPECT_EQ(number_after_a_round_trip(std::numeric_limits<double>::infinity()),
              std::numeric_limits<double>::infinity());
    EXPECT_TRUE(std::isnan(number_after_a_round_trip(std::nan(""))));
}

TEST(GraphJson, KeepsBytesThatAreNoUtf8) {
    Graph graph = graph_with({std::string("sc\xe4ne/\xff\xfe.pbrt")});
    graph.file = "sc\xe4ne/box.lua";
    graph.nodes[0].where.file = graph.file;
    EXPECT_EQ(graph_from_json(to_json(graph)), graph);
    const std::vector<Problem> problems{{{"sc\xe4ne/box.lua", 7}, "there is no f\xfc\xdf.png"}};
    EXPECT_EQ(problems_from_json(to_json(problems)), problems);
    for (const char* text : {R"({"bytes":"f"})", R"({"bytes":"zz"})", R"({"bytes":1})", R"({"bytes":"ff","more":1})"})
        EXPECT_THROW(text_from_json(parse_json(text)), Error) << text;
}

TEST(GraphJson, RefusesWhatIsNoGraph) {
    for (const char* text :
         {"", "{", "[]", "null", "{}", R"({"file":"g"})", R"({"file":1,"nodes":[]})",
          R"({"file":"g","nodes":[],"more":1})", R"({"file":"g","nodes":[{}]})", R"({"file":"g","nodes":{"a":1}})"})
        EXPECT_THROW(graph_from_json(text), Error) << text;
}

TEST(GraphJson, RefusesEveryTruncation) {
    const std::string text = to_json(parse("a = Ambient { rays = 3 }\nb = Combine { a }"));
    for (std::size_t size = 0; size < text.size(); ++size)
        EXPECT_THROW(graph_from_json(text.substr(0, size)), Error) << size;
}

TEST(GraphJson, RefusesDepthAndSizeWithoutEnd) {
    EXPECT_THAT(error_of([] { graph_from_json(std::string(100000, '[')); }), HasSubstr("nested too deeply"));
    EXPECT_THAT(error_of([] { graph_from_json(std::string((16 << 20) + 1, ' ')); }), HasSubstr("16 MiB"));
}

TEST(HostsJson, ComesBackEqual) {
    const Hosts hosts{"h.lua", {{"tcp://a:1", {{"x", 2}}, 3, {"h.lua", 4}}, {"tcp://b:1", {}, 0, {"h.lua", 5}}}};
    EXPECT_EQ(hosts_from_json(to_json(hosts)), hosts);
    EXPECT_THROW(
        hosts_from_json(R"({"file":"h","hosts":[{"endpoint":"e","replicas":{"x":-1},"places":0,"where":["h",1]}]})"),
        Error);
}

TEST(PlanJson, ComesBackEqual) {
    Plan plan{{{"tcp://a:1", 0}, {"", 1}}, {{0, 1}, {}, {1}}};
    plan.processes = {{"tcp://a:1", ~std::uint64_t{0}}};
    plan.edition = 7;
    EXPECT_EQ(plan_from_json(to_json(plan)), plan);
    EXPECT_EQ(plan_from_json(to_json(plan)).edition, 7u);
}

TEST(PlanJson, RefusesAPlaceThatIsNotThere) {
    EXPECT_THROW(plan_from_json(R"({"places":[["",0]],"places_of":[[1]]})"), Error);
}

TEST(ProblemsJson, ComesBackEqual) {
    const std::vector<Problem> problems{{{"g.lua", 3}, "a 'b'\nc"}, {{"", 0}, ""}};
    EXPECT_EQ(problems_from_json(to_json(problems)), problems);
}

}  // namespace
}  // namespace lightnet::json_test
