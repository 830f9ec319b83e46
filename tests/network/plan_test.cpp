#include "core/network/graph/plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "core/network/graph/layout.hpp"
#include "tests/support/parse.hpp"

namespace lightnet::plan_test {
namespace {

using test::fake_registry;
using test::sound_graph;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

// nodes: 0 a, 1 b, 2 lighting, 3 scene, 4 image
Graph graph() { return sound_graph("a = Ambient {} b = Ambient {} lighting = Combine { a, b }"); }

Plan plan_for(const std::string& hosts, const std::vector<HostOffer>& offers) {
    return plan(graph(), fake_registry(), parse_hosts(hosts, "hosts.lua"), offers);
}

TEST(Plan, GivesEachPlaceTheWholeNetworkByDefault) {
    const Plan where = plan(graph(), fake_registry(), {}, {{"", 3}});
    EXPECT_THAT(where.places, ElementsAre(PlaceAt{"", 0}, PlaceAt{"", 1}, PlaceAt{"", 2}));
    EXPECT_THAT(where.places_of, ElementsAre(ElementsAre(0, 1, 2), ElementsAre(0, 1, 2), ElementsAre(0, 1, 2),
                                             IsEmpty(), ElementsAre(0, 1, 2)));
}

TEST(Plan, GivesEveryReplicaAPlace) {
    const Plan where = plan_for("place 'tcp://x:1' { a = 3, b = 1, lighting = 1, image = 1 }", {{"tcp://x:1", 1}});
    EXPECT_THAT(where.places_of[0], SizeIs(3));
    EXPECT_THAT(std::set(where.places_of[0].begin(), where.places_of[0].end()), SizeIs(3)) << "each its own";
    for (const std::size_t node : {1, 2, 4}) EXPECT_THAT(where.places_of[node], SizeIs(1));
    EXPECT_THAT(where.places, SizeIs(3));
}

TEST(Plan, SpreadsNodesOverHosts) {
    const Plan where =
        plan_for("place 'tcp://x:1' { a = 1, lighting = 1 }\nplace 'tcp://y:1' { a = 1, b = 1, image = 1 }",
                 {{"tcp://x:1", 1}, {"tcp://y:1", 2}});
    EXPECT_THAT(where.places, ElementsAre(PlaceAt{"tcp://x:1", 0}, PlaceAt{"tcp://y:1", 0}, PlaceAt{"tcp://y:1", 1}));
    EXPECT_THAT(where.places_of,
                ElementsAre(ElementsAre(0, 1), ElementsAre(2), ElementsAre(0), IsEmpty(), ElementsAre(1)));
}

TEST(Plan, TellsWhoAnswersAlone) {
    const std::vector<HostOffer> two{{"tcp://x:1", 1}, {"tcp://y:1", 1}};
    const auto alone = [&](const std::string& hosts, std::size_t node) {
        return answers_alone(plan_for(hosts, two), graph(), node);
    };
    constexpr std::size_t a = 0, lighting = 2, image = 4;
    EXPECT_TRUE(alone("", image)) << "each has all";
    const std::string spread = "place 'tcp://x:1' { lighting = 1, a = 1, b = 1 } place 'tcp://y:1' { image = 1 }";
    EXPECT_TRUE(alone(spread, lighting));
    EXPECT_FALSE(alone(spread, image)) << "it asks the other";
    const std::string relieved = "place 'tcp://x:1' {} place 'tcp://y:1' { a = 1 }";
    EXPECT_TRUE(alone(relieved, a));
    EXPECT_FALSE(alone(relieved, image)) << "questions to a may go to the other";
}

TEST(Plan, HasANodeBesideWhoeverTakesItsFrozenState) {
    const Graph taking = sound_graph("a = Ambient {} b = Cache { a } c = Reuse { of = b } lighting = Combine { b, c }");
    const Plan where = plan(taking, fake_registry(),
                            parse_hosts("place 'tcp://x:1' { a = 1, b = 1, image = 1 }\n"
                                        "place 'tcp://y:1' { lighting = 1 } place 'tcp://z:1' { c = 2 }",
                                        "hosts.lua"),
                            {{"tcp://x:1", 1}, {"tcp://y:1", 1}, {"tcp://z:1", 1}});
    EXPECT_THAT(where.places_of[2], ElementsAre(2, 3)) << "as the file says";
    EXPECT_THAT(where.places_of[1], ElementsAre(0, 2, 3)) << "and where it is taken from";
    EXPECT_THAT(where.places_of[0], ElementsAre(0)) << "whom it asks may be elsewhere";
}

TEST(Plan, MakesNoPlaceWithoutANode) {
    EXPECT_THAT(plan_for("place 'tcp://x:1' { a = 1, b = 1, lighting = 1, image = 1 }", {{"tcp://x:1", 16}}).places,
                SizeIs(4));
}

TEST(Plan, RecreatesNodesOfAbsentHostsWhereTheFewestAre) {
    const Plan where = plan_for(
        "place 'tcp://x:1' { a = 1, lighting = 1 }\nplace 'tcp://y:1' { image = 1 }\n"
        "place 'tcp://gone:1' { b = 2 }",
        {{"tcp://x:1", 1}, {"tcp://y:1", 1}});
    EXPECT_THAT(where.places_of[1], ElementsAre(1));
}

TEST(Plan, KeepsReplicasThatAreLeft) {
    const Plan where =
        plan_for("place 'tcp://x:1' { a = 1, b = 1, lighting = 1, image = 1 }\nplace 'tcp://gone:1' { a = 1 }",
                 {{"tcp://x:1", 1}});
    EXPECT_THAT(where.places_of[0], ElementsAre(0));
}

TEST(Plan, GivesWhoeverJoinsTheWholeNetwork) {
    const Plan where = plan_for("place 'tcp://x:1' { a = 1 }", {{"tcp://x:1", 1}, {"tcp://new:1", 1}});
    EXPECT_THAT(where.places_of[0], ElementsAre(0, 1));
    EXPECT_THAT(where.places_of[4], ElementsAre(1));
}

TEST(Plan, TakesTheNumberOfPlacesFromTheHostsFile) {
    EXPECT_THAT(plan_for("place 'tcp://x:1' { places = 2 }", {{"tcp://x:1", 8}}).places, SizeIs(2));
    EXPECT_THAT(plan_for("place 'tcp://x:1'", {{"tcp://x:1", 8}}).places, SizeIs(8));
}

TEST(Plan, LeavesOutWhatThePictureDoesNotNeed) {
    const Graph idle = sound_graph("idle = Ambient {} lighting = Ambient {}");
    EXPECT_THAT(plan(idle, fake_registry(), {}, {{"", 2}}).places_of[0], IsEmpty());
}

TEST(Plan, SaysHowAskersChoose) {
    const Plan where =
        plan_for("strategy = 'affinity'\nstrategy { b = 'fastest' }\nplace 'tcp://x:1'", {{"tcp://x:1", 1}});
    EXPECT_EQ(where.strategy_of(0), Strategy::affinity);
    EXPECT_EQ(where.strategy_of(1), Strategy::fastest);
    EXPECT_EQ(plan_from_json(to_json(where)), where);
}

TEST(Plan, GivesEachEntryForThisProcessPlacesOfItsOwn) {
    const Plan where = plan_for(
        "place 'here' { a = 2 }\nplace 'tcp://x:1' { b = 1 }\nplace 'here' { lighting = 1, image = 1, places = 1 }",
        {{"", 1}, {"tcp://x:1", 1}});
    EXPECT_THAT(where.places, ElementsAre(PlaceAt{"", 0}, PlaceAt{"", 1}, PlaceAt{"", 2}, PlaceAt{"tcp://x:1", 0}));
    EXPECT_THAT(where.places_of,
                ElementsAre(ElementsAre(0, 1), ElementsAre(3), ElementsAre(2), IsEmpty(), ElementsAre(2)));
    EXPECT_EQ(places_of_host(where, ""), 3u);
    EXPECT_EQ(places_of_host(where, "tcp://x:1"), 1u);
}

TEST(Plan, DealsOutNodesOfThisProcessAsItDoesThoseOfHosts) {
    for (const char* entry : {"{ a = 3, b = 1, lighting = 1, image = 1 }", "{ a = 1, b = 1, image = 2, places = 2 }",
                              "{ places = 3 }", "{}"}) {
        Plan here = plan_for("place 'here' " + std::string(entry), {{"", 2}});
        for (auto& place : here.places) place.host = "tcp://x:1";
        EXPECT_EQ(here, plan_for("place 'tcp://x:1' " + std::string(entry), {{"tcp://x:1", 2}})) << entry;
    }
}

TEST(Plan, GivesEachEntryForThisProcessSectorsOfItsOwn) {
    const Hosts hosts =
        parse_hosts("layout { a = 'sharded' } place 'here' { a = 1, image = 1 } place 'here' { a = 2 }", "hosts.lua");
    const Graph cut = sharded(graph(), shards_of(graph(), fake_registry(), hosts));
    ASSERT_EQ(cut.sectors.size(), 3u);
    const Plan where = plan(cut, fake_registry(), hosts, {{"", 2}});
    const auto sectors = sectors_of(cut, 0);
    EXPECT_THAT(where.places_of[sectors[0]], SizeIs(1));
    for (const auto sector : sectors)
        EXPECT_EQ(where.places_of[sector][0] < 2, sector == sectors[0]) << "two places, then two";
    EXPECT_NE(where.places_of[sectors[1]], where.places_of[sectors[2]]);
}

TEST(Plan, WantsAPlace) { EXPECT_THROW(plan(graph(), fake_registry(), {}, {}), Error); }

}  // namespace
}  // namespace lightnet::plan_test
