// The tiles of a picture, pass by pass; and which nodes are made anew for each.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/film/film.hpp"
#include "core/network/graph/check.hpp"
#include "core/run/assembly/prepared.hpp"
#include "core/run/master/tiles_by_pass.hpp"
#include "lua/load_graph.hpp"
#include "nodes/standard_nodes.hpp"

namespace lightnet::tiles_by_pass_test {
namespace {

const Registry& kinds() {
    static const Registry all{standard_nodes()};
    return all;
}

Graph graph_of(const std::string& light) {
    return check(parse_graph("scene = Scene { 'none.pbrt' }\n" + light +
                                 "\nimage = RayTracer { light, scene = scene, film = { 8, 8 } }",
                             "test.lua"),
                 kinds());
}

TEST(TilesByPass, AreBlocksOfSamplesOneAfterTheOther) {
    TilesByPass passes(graph_of("light = ProgressivePhotonMapping {}"), kinds(), tiles_of(8, 8, 4, 100));
    EXPECT_EQ(passes.pass(), 0u);
    std::vector<std::uint32_t> samples;
    for (std::uint32_t pass = 0; !passes.empty(); ++pass) {
        const auto tiles = passes.begin_next();
        EXPECT_EQ(passes.pass(), pass);
        ASSERT_EQ(tiles.size(), 4u);
        for (const Tile& tile : tiles) EXPECT_EQ(tile.first_sample, pass * samples_per_block);
        samples.push_back(tiles[0].samples);
    }
    EXPECT_THAT(samples, testing::ElementsAre(16, 16, 16, 16, 16, 16, 4));
}

TEST(TilesByPass, KeepThoseThatComeLaterForTheirPass) {
    TilesByPass passes(graph_of("light = ProgressivePhotonMapping {}"), kinds(), {{0, 0, 4, 4, 32, 16}});
    EXPECT_EQ(passes.pass(), 2u) << "a run that goes on in the middle";
    passes.begin_next();
    const Tile now{4, 0, 4, 4, 32, 16}, later{0, 0, 4, 4, 48, 16};
    EXPECT_THAT(passes.sort({later, now}), testing::ElementsAre(now));
    EXPECT_THAT(passes.begin_next(), testing::ElementsAre(later));
    EXPECT_TRUE(passes.empty());
}

TEST(TilesByPass, StayTogetherWhereNoNodeLearnsAnew) {
    const auto tiles = tiles_of(8, 8, 4, 100);
    TilesByPass passes(graph_of("light = PathTracing {}"), kinds(), tiles);
    EXPECT_EQ(passes.begin_next(), tiles);
    EXPECT_TRUE(passes.empty());
}

TEST(RenewedNodes, AreThoseThatLearnAnewAndThoseThatLearnFromThem) {
    const Graph graph = graph_of(
        "maps = ProgressivePhotonMapping {}\npaths = PathTracing {}\nfirst = Combine { maps, paths }\n"
        "soft = IrradianceCache { first }\nhard = IrradianceCache { paths }\ndots = RecordPositions { of = soft }\n"
        "gathered = FinalGather { soft }\nlight = Combine { gathered, hard }");
    std::vector<std::string> renewed;
    const auto which = renewed_nodes(graph, kinds());
    for (std::size_t node = 0; node < which.size(); ++node)
        if (which[node]) renewed.push_back(graph.nodes[node].name);
    EXPECT_THAT(renewed, testing::UnorderedElementsAre("maps", "soft", "dots"));
}

TEST(ProgressivePhotonMapping, SaysWhatBecameOfItsPasses) {
    try {
        graph_of("light = ProgressivePhotonMapping { passes = 64 }");
        FAIL() << "it has no passes any more";
    } catch (const UserError& error) {
        EXPECT_THAT(error.what(),
                    testing::HasSubstr("test.lua:2: ProgressivePhotonMapping 'light': there is no parameter "
                                       "'passes' any more: each sample of a pixel has photons of its own"));
    }
}

}  // namespace
}  // namespace lightnet::tiles_by_pass_test
