#include "core/network/graph/layout.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/network/graph/dot.hpp"
#include "core/network/graph/plan.hpp"
#include "tests/support/parse.hpp"

namespace lightnet::layout_test {
namespace {

using test::fake_registry;
using test::sound_graph;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

using Shards = std::map<std::string, std::uint32_t>;

// nodes: 0 a, 1 lighting, 2 scene, 3 image
Graph graph() { return sound_graph("a = Ambient {} lighting = Combine { a }"); }

Hosts hosts(const std::string& text) { return parse_hosts(text, "hosts.lua"); }

Shards shards(const std::string& text) { return shards_of(graph(), fake_registry(), hosts(text)); }

TEST(Layout, HasASectorForEachReplicaOfAShardedNode) {
    EXPECT_EQ(shards("layout { a = 'sharded' }\nplace 'tcp://x:1' { a = 3 }\nplace 'tcp://y:1' { a = 1, image = 1 }"),
              (Shards{{"a", 4}}));
}

TEST(Layout, HasASectorForEachHostOfTheWholeNetwork) {
    EXPECT_EQ(shards("layout = 'sharded'\nplace 'tcp://x:1' { places = 8 }\nplace 'tcp://y:1'"), (Shards{{"a", 2}}));
}

TEST(Layout, OfANodeComesBeforeThatOfAll) {
    const std::string two = "\nplace 'tcp://x:1'\nplace 'tcp://y:1'";
    EXPECT_EQ(shards("layout { a = 'replicated' }\nlayout = 'sharded'" + two), Shards{});
    EXPECT_EQ(shards("layout { a = 'sharded' }\nlayout = 'replicated'" + two), (Shards{{"a", 2}}));
    EXPECT_EQ(shards(two), Shards{}) << "replicated, unless it is said";
}

TEST(Layout, LeavesWhatOnePlaceHasWhole) { EXPECT_EQ(shards("layout = 'sharded'\nplace 'tcp://x:1'"), Shards{}); }

TEST(Layout, LeavesWholeWhatAnotherNodeTakes) {
    const auto shards_with = [](const std::string& taker) {
        const Graph kept = sound_graph("a = Ambient {} b = Cache { a }" + taker);
        return shards_of(kept, fake_registry(), hosts("layout = 'sharded'\nplace 'tcp://x:1'\nplace 'tcp://y:1'"));
    };
    EXPECT_EQ(shards_with(" lighting = Combine { b }"), (Shards{{"a", 2}, {"b", 2}}));
    EXPECT_EQ(shards_with(" c = Reuse { of = b } lighting = Combine { b, c }"), (Shards{{"a", 2}}));
}

TEST(Layout, GivesASectorANodeOfItsOwn) {
    const Graph cut = sharded(graph(), {{"a", 3}});
    EXPECT_EQ(written_nodes(cut), 4u);
    EXPECT_THAT(sectors_of(cut, 0), ElementsAre(4, 5, 6));
    EXPECT_THAT(sectors_of(cut, 1), IsEmpty());
    EXPECT_EQ(cut.nodes[5].name, "a#2");
    EXPECT_EQ(whole_of(cut, 5), 0u);
    EXPECT_EQ(whole_of(cut, 1), 1u);
    EXPECT_EQ(*sector_at(cut, 6), (Sector{0, 2, 3}));
    EXPECT_EQ(sector_at(cut, 0), nullptr);
    EXPECT_EQ(cut.inputs_of(1), graph().inputs_of(1)) << "who asks it knows nothing of that";
    EXPECT_EQ(written(cut), graph());
    EXPECT_THROW(sharded(graph(), {{"nobody", 2}}), Error);
    EXPECT_THROW(sharded(graph(), {{"a", 1}}), Error);
    EXPECT_THROW(sharded(graph(), {{"a", 5000}}), Error);
}

TEST(Layout, TravelsWithTheGraph) {
    const Graph cut = sharded(graph(), {{"a", 3}});
    EXPECT_EQ(graph_from_json(to_json(cut)), cut);
    EXPECT_EQ(check(cut, fake_registry()), cut);
    EXPECT_THROW(graph_from_json(R"({"file":"g","nodes":[],"shards":{"a":2}})"), Error);
    EXPECT_THROW(graph_from_json(R"({"file":"g","nodes":[],"shards":[2]})"), Error);
}

Plan plan_for(const std::string& text, const std::vector<HostOffer>& offers) {
    const Graph cut = sharded(graph(), shards(text));
    return plan(cut, fake_registry(), hosts(text), offers);
}

const std::string three_and_one =
    "layout { a = 'sharded' }\nplace 'tcp://x:1' { a = 3 }\n"
    "place 'tcp://y:1' { a = 1, lighting = 1, image = 1 }";

TEST(Layout, GivesSectorsToHostsInTheOrderOfTheFile) {
    const Plan where = plan_for(three_and_one, {{"tcp://x:1", 1}, {"tcp://y:1", 3}});
    EXPECT_THAT(where.places_of[0], IsEmpty()) << "nobody has all of it";
    EXPECT_THAT(where.places, ElementsAre(PlaceAt{"tcp://x:1", 0}, PlaceAt{"tcp://x:1", 1}, PlaceAt{"tcp://x:1", 2},
                                          PlaceAt{"tcp://y:1", 0}, PlaceAt{"tcp://y:1", 1}, PlaceAt{"tcp://y:1", 2}));
    EXPECT_THAT(where.places_of[4], ElementsAre(0));
    EXPECT_THAT(where.places_of[5], ElementsAre(1));
    EXPECT_THAT(where.places_of[6], ElementsAre(2));
    EXPECT_THAT(where.places_of[7], ElementsAre(5));
}

TEST(Layout, GivesAllPlacesOfAHostWithTheWholeNetworkTheHostsSector) {
    const Plan where =
        plan_for("layout = 'sharded'\nplace 'tcp://x:1' { places = 2 }\nplace 'tcp://y:1' { places = 1 }",
                 {{"tcp://x:1", 8}, {"tcp://y:1", 8}});
    EXPECT_THAT(where.places_of[4], ElementsAre(0, 1));
    EXPECT_THAT(where.places_of[5], ElementsAre(2));
    EXPECT_THAT(where.places_of[3], ElementsAre(0, 1, 2));
}

TEST(Layout, KeepsSectorsWhereTheyAreWhenAHostIsLostAndSharesOutItsOwn) {
    const Plan left = plan_for(three_and_one, {{"tcp://y:1", 1}});
    EXPECT_THAT(left.places_of[7], ElementsAre(0));
    for (const std::size_t lost : {4, 5, 6}) EXPECT_THAT(left.places_of[lost], testing::SizeIs(1));
    const Plan other = plan_for(three_and_one, {{"tcp://x:1", 1}});
    EXPECT_THAT(other.places_of[4], ElementsAre(0));
    EXPECT_THAT(other.places_of[5], ElementsAre(1));
    EXPECT_THAT(other.places_of[6], ElementsAre(2));
    EXPECT_THAT(other.places_of[7], testing::SizeIs(1));
}

TEST(Layout, GivesHostsThatJoinNoSector) {
    const Plan where = plan_for("layout = 'sharded'\nplace 'tcp://x:1'\nplace 'tcp://y:1'",
                                {{"tcp://x:1", 1}, {"tcp://y:1", 1}, {"tcp://new:1", 1}});
    EXPECT_THAT(where.places_of[4], ElementsAre(0));
    EXPECT_THAT(where.places_of[5], ElementsAre(1));
    EXPECT_THAT(where.places_of[3], ElementsAre(0, 1, 2));
}

TEST(Layout, IsDrawn) {
    const Graph cut = sharded(graph(), shards(three_and_one));
    const Plan where = plan_for(three_and_one, {{"tcp://x:1", 1}, {"tcp://y:1", 3}});
    const std::string drawn = to_dot(cut, fake_registry(), &where);
    for (const char* line : {"node_a_of_2_1 [label=\"a#2\\nAmbient\"];",
                             "route_a_3 [shape=invtrapezium, style=solid, label=\"a by place\\n4 sectors\"];",
                             "node_lighting_3 -> route_a_3 [label=\"Query → Rgb\\ncall\"];",
                             "route_a_3 -> node_a_of_1_0 [label=\"Query → Rgb\\ntcp bundles\"];",
                             "route_a_3 -> node_a_of_4_5 [label=\"Query → Rgb\\ninproc bundles\"];"})
        EXPECT_THAT(drawn, HasSubstr(line));
}

}  // namespace
}  // namespace lightnet::layout_test
