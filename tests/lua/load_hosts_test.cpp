#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lua/load_graph.hpp"
#include "tests/support/parse.hpp"

namespace lightnet::load_hosts_test {
namespace {

using testing::HasSubstr;

std::string error_in(const std::string& text) {
    return test::error_of([&] { parse_hosts(text, "hosts.lua"); });
}

TEST(LoadHosts, MakesAnEntryOfEachPlace) {
    const Hosts hosts = parse_hosts(
        "place 'tcp://a:7777' { sky = 2, image = 1 }\nplace 'tcp://b:7777' { places = 4 }\nplace 'tcp://c:7777'",
        "hosts.lua");
    EXPECT_EQ(hosts, (Hosts{"hosts.lua",
                            {{"tcp://a:7777", {{"sky", 2}, {"image", 1}}, 0, {"hosts.lua", 1}},
                             {"tcp://b:7777", {}, 4, {"hosts.lua", 2}},
                             {"tcp://c:7777", {}, 0, {"hosts.lua", 3}}}}));
}

TEST(LoadHosts, KeepsEveryEntryForThisProcess) {
    const Hosts hosts = parse_hosts("for i = 1, 3 do place 'here' { sky = 1 } end place 'tcp://a:7'", "hosts.lua");
    ASSERT_EQ(hosts.hosts.size(), 4u);
    EXPECT_TRUE(hosts.hosts[2].is_here());
    EXPECT_EQ(hosts.hosts[2].host(), "");
    EXPECT_EQ(hosts.hosts[3].host(), "tcp://a:7");
    EXPECT_EQ(hosts_from_json(to_json(hosts)), hosts);
}

TEST(LoadHosts, ComputesHosts) {
    const Hosts hosts = parse_hosts("for i = 1, 3 do place('tcp://onyx' .. i .. ':7777') { sky = i } end", "hosts.lua");
    ASSERT_EQ(hosts.hosts.size(), 3u);
    EXPECT_EQ(hosts.hosts[2].endpoint, "tcp://onyx3:7777");
    EXPECT_EQ(hosts.hosts[2].replicas.at("sky"), 3);
}

TEST(LoadHosts, WantsWholeNumbersOfReplicas) {
    EXPECT_THAT(error_in("place 'tcp://a:7' { sky = 1.5 }"),
                HasSubstr("hosts.lua:1: place 'tcp://a:7': how many 'sky'?"));
    EXPECT_THAT(error_in("place 'tcp://a:7' { sky = 'two' }"), HasSubstr("how many 'sky'?"));
    EXPECT_THAT(error_in("place 'tcp://a:7' { 'sky' }"), HasSubstr("nodes go by name"));
}

TEST(LoadHosts, TakesAStrategyForAllAndForSomeNodes) {
    const Hosts hosts = parse_hosts(
        "strategy = 'affinity'\nstrategy { sky = 'affinity', bounce = 'fastest' }\nplace 'tcp://a:7'", "hosts.lua");
    EXPECT_EQ(hosts.strategies, (std::vector<ChoiceEntry>{{"", "affinity", {"hosts.lua", 1}},
                                                          {"bounce", "fastest", {"hosts.lua", 2}},
                                                          {"sky", "affinity", {"hosts.lua", 2}}}));
    EXPECT_THAT(error_in("strategy = 3"), HasSubstr("hosts.lua:1: strategy is called by name"));
    EXPECT_THAT(error_in("strategy { 'fastest' }"), HasSubstr("nodes and strategies go by name"));
    EXPECT_THAT(error_in("strategy(1)"), HasSubstr("strategy takes a table"));
}

TEST(LoadHosts, TakesALayoutForAllAndForSomeNodes) {
    const Hosts hosts =
        parse_hosts("layout = 'sharded'\nlayout { sky = 'replicated' }\nplace 'tcp://a:7'", "hosts.lua");
    EXPECT_EQ(hosts.layouts,
              (std::vector<ChoiceEntry>{{"", "sharded", {"hosts.lua", 1}}, {"sky", "replicated", {"hosts.lua", 2}}}));
    EXPECT_TRUE(hosts.strategies.empty());
    EXPECT_EQ(hosts_from_json(to_json(hosts)), hosts);
    EXPECT_THAT(error_in("layout = 3"), HasSubstr("hosts.lua:1: layout is called by name: layout = \"sharded\""));
    EXPECT_THAT(error_in("layout { 'sharded' }"), HasSubstr("nodes and layouts go by name"));
    EXPECT_THAT(error_in("layout(1)"), HasSubstr("layout takes a table"));
}

TEST(LoadHosts, KnowsNothingButPlaces) {
    EXPECT_THAT(error_in("\nsky = Ambient {}"), HasSubstr("hosts.lua:2: a hosts file knows only place"));
    EXPECT_THAT(error_in("place { sky = 1 }"), HasSubstr("place takes the host first"));
    EXPECT_THAT(error_in("place 'tcp://a:7' (2)"), HasSubstr("takes a table"));
    EXPECT_THAT(error_in("local x = plac"), HasSubstr("nothing is called 'plac' (did you mean 'place'?)"));
}

}  // namespace
}  // namespace lightnet::load_hosts_test
