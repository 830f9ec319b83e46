// What check() says of groups of lamps.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/network/graph/plan.hpp"
#include "nodes/standard_nodes.hpp"
#include "tests/support/parse.hpp"

namespace lightnet::mistaken_groups_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Registry standard() { return Registry(standard_nodes()); }

Graph graph(const std::string& nodes, const std::string& groups = "key = 'spot*', fill = { 'panel', 'strip' }",
            const std::string& more = "") {
    return test::parse(nodes + "\nscene = Scene { 'room.pbrt', groups = { " + groups + " } }\n" +
                       "image = RayTracer { lighting, scene = scene, " + more + "film = { 8, 4 } }\n");
}

std::string problems(const Graph& graph) {
    return test::error_of([&] { check(graph, standard()); });
}

std::vector<std::string> said(const std::vector<Problem>& problems) {
    std::vector<std::string> texts;
    for (const auto& problem : problems) texts.push_back(problem.what);
    return texts;
}

TEST(GroupsInGraphs, MakeALayerForEach) {
    const Graph sound =
        check(graph("d = DirectLighting { groups = true } p = PathTracing {} lighting = Combine { d, p }",
                    "key = 'spot'", "groups = true, "),
              standard());
    EXPECT_THAT(layers_of(sound, standard()).film,
                ElementsAre("emission.key", "emission.rest", "d.key", "d.rest", "p"));
}

TEST(GroupsInGraphs, AreToldWhereOneIsCountedTwice) {
    const auto found = examine(graph("d = DirectLighting {} k = DirectLighting { lamps = 'key' } p = PathTracing {} "
                                     "lighting = Combine { d, k, p }"),
                               standard());
    EXPECT_THAT(said(found.warnings),
                ElementsAre("DirectLighting 'k': LDE from lamps of 'key' is counted by 'd' and 'k'"));
    EXPECT_THAT(found.notes, IsEmpty());
}

TEST(GroupsInGraphs, AreToldWhereOneIsNeverCounted) {
    const auto found = examine(graph("d = DirectLighting { lamps = { 'key', 'rest' } } p = PathTracing {} "
                                     "lighting = Combine { d, p }"),
                               standard());
    EXPECT_THAT(found.warnings, IsEmpty());
    EXPECT_THAT(said(found.notes), ElementsAre("RayTracer 'image': no node counts LDE from lamps of 'fill'"));
}

TEST(GroupsInGraphs, MayBeSharedOutAmongOperators) {
    const auto found =
        examine(graph("k = DirectLighting { lamps = 'key' } f = DirectLighting { lamps = { 'fill', 'rest' } }"
                      "p = PathTracing {} lighting = Combine { k, f, p }"),
                standard());
    EXPECT_THAT(found.warnings, IsEmpty());
    EXPECT_THAT(found.notes, IsEmpty());
}

TEST(GroupsInGraphs, HaveToBeThere) {
    EXPECT_THAT(problems(graph("lighting = DirectLighting { lamps = 'kye' }")),
                HasSubstr("DirectLighting 'lighting': 'lamps': the scene has no group 'kye' (did you mean 'key'?)"));
    EXPECT_THAT(problems(test::parse("scene = Scene { 'room.pbrt' } lighting = DirectLighting { groups = true }\n"
                                     "image = RayTracer { lighting, scene = scene, film = { 8, 4 } }")),
                HasSubstr("'groups': the scene has no groups of lamps: write Scene {"));
}

TEST(GroupsInGraphs, HaveNamesThatMeanNothingElse) {
    EXPECT_THAT(problems(graph("lighting = DirectLighting {}", "lighting = 'spot'")),
                HasSubstr("'lighting' is the name of a node already: call the group something else"));
    EXPECT_THAT(problems(graph("lighting = DirectLighting {}", "rest = 'spot'")),
                HasSubstr("'rest' is the group of what no other one names"));
    EXPECT_THAT(problems(graph("lighting = DirectLighting {}", "key = {}")), HasSubstr("'key' names no lamp"));
    EXPECT_THAT(problems(graph("lighting = DirectLighting {}", "key = 3")),
                HasSubstr("'groups': 'key' must be a name or a list of names, not a number"));
    EXPECT_THAT(problems(graph("lighting = DirectLighting { lamps = 3 }")),
                HasSubstr("'lamps' must be a name or a list of names, not a number"));
}

TEST(GroupsInGraphs, AreKeptApartAllTheWayUp) {
    EXPECT_THAT(
        problems(graph("d = DirectLighting {} c = Clamp { d } lighting = IrradianceCache { c, groups = true }")),
        HasSubstr("IrradianceCache 'lighting': keeps groups of lamps apart, but its input 'c' does not"));
    EXPECT_THAT(problems(graph("d = DirectLighting { groups = true } s = Scale { d, factor = 2 } "
                               "lighting = IrradianceCache { s, groups = true }")),
                IsEmpty());
    EXPECT_THAT(problems(graph("d = DirectLighting { groups = true } "
                               "lighting = IrradianceCache { d, groups = true, keep = 'x.records' }")),
                HasSubstr("'groups' exclude 'keep' and 'extend'"));
}

}  // namespace
}  // namespace lightnet::mistaken_groups_test
