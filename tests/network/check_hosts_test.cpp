#include "core/network/graph/check_hosts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/parse.hpp"

namespace lightnet::check_hosts_test {
namespace {

using testing::HasSubstr;

std::string problems_with_hosts(const std::string& hosts) {
    return test::problems_of(
        "sky = Ambient {}\nbox = Scene { 'b.pbrt' }\n"
        "image = RayTracer { sky, scene = box, film = { 8, 8 } }",
        parse_hosts(hosts, "hosts.lua"));
}

TEST(CheckHosts, AcceptsWhatCanRun) {
    EXPECT_EQ(problems_with_hosts("place 'tcp://a:7777' { sky = 2, image = 1 }\nplace 'tcp://b:7777'"), "");
}

TEST(CheckHosts, SuggestsTheNodeYouMeant) {
    EXPECT_EQ(problems_with_hosts("\nplace 'tcp://a:7777' { skye = 1 }"),
              "hosts.lua:2: place 'tcp://a:7777': no node called 'skye' (did you mean 'sky'?)");
}

TEST(CheckHosts, KeepsScenesOutOfIt) {
    EXPECT_THAT(problems_with_hosts("place 'tcp://a:7777' { box = 1 }"),
                HasSubstr("'box' is a scene, which every host has"));
}

TEST(CheckHosts, WantsAnEndpoint) {
    for (const char* endpoint : {"onyx1:7777", "tcp://onyx1", "tcp://:7", "tcp://a:0", "tcp://a:70000", "tcp://a:7x",
                                 "udp://a:7", "tcp://a b:7", "tcp://*:7", "tcp://::1:7", "tcp://[onyx1]:7"})
        EXPECT_THAT(problems_with_hosts("place '" + std::string(endpoint) + "' {}"), HasSubstr("tcp://host:7777"))
            << endpoint;
}

TEST(CheckHosts, TakesAddressesOfBothFamilies) {
    for (const char* endpoint : {"tcp://10.0.0.1:7", "tcp://[::1]:7", "tcp://[fe80::1%eth0]:7", "tcp://[fd00::1]:7"})
        EXPECT_EQ(problems_with_hosts("place '" + std::string(endpoint) + "' {}"), "");
    EXPECT_EQ(address_of("tcp://[fe80::1%eth0]:7777")->host, "fe80::1%eth0");
    EXPECT_THAT(problems_with_hosts("place 'tcp://300.0.0.1:7' {}"), HasSubstr("no host is called '300.0.0.1'"));
    EXPECT_THAT(problems_with_hosts("place 'tcp://[fe80::1]:7' {}"), HasSubstr("as in [fe80::1%eth0]"));
    EXPECT_THAT(problems_with_hosts("place 'tcp://[::1]:7' {}\nplace 'tcp://[0:0::1]:7' {}"),
                HasSubstr("hosts.lua:2: place 'tcp://[0:0::1]:7': the host stands here twice"));
}

TEST(CheckHosts, TakesNamesOfHostsThatJoinByThemselves) {
    EXPECT_EQ(problems_with_hosts("place 'onyx1' {}\nplace 'slurm-12_3.a' {}"), "");
}

TEST(CheckHosts, TakesThisProcessAsOftenAsOneLikes) {
    EXPECT_EQ(problems_with_hosts("place 'here' { sky = 2 }\nplace 'here' { image = 1, places = 1 }\nplace 'here'"),
              "");
    EXPECT_EQ(problems_with_hosts("place 'here' {}\nplace 'here' { skye = 1 }"),
              "hosts.lua:2: place 'here': no node called 'skye' (did you mean 'sky'?)");
    EXPECT_THAT(problems_with_hosts("place 'here' { sky = 3, places = 2 }"),
                HasSubstr("place 'here': 3 replicas of 'sky' need as many places, but it has 2"));
    EXPECT_THAT(problems_with_hosts("place 'this process' {}"), HasSubstr("this process is called here"));
    EXPECT_FALSE(is_joining_name("here"));
}

TEST(CheckHosts, WantsEachHostOnce) {
    EXPECT_THAT(problems_with_hosts("place 'tcp://a:7' {}\nplace 'tcp://a:7' {}"),
                HasSubstr("hosts.lua:2: place 'tcp://a:7': the host stands here twice"));
}

TEST(CheckHosts, WantsCountsThatMakeSense) {
    EXPECT_THAT(problems_with_hosts("place 'tcp://a:7' { sky = 0 }"),
                HasSubstr("it must hold 1 … 1024 replicas, not 0"));
    EXPECT_THAT(problems_with_hosts("place 'tcp://a:7' { sky = 3, places = 2 }"),
                HasSubstr("need as many places, but it has 2"));
    EXPECT_THAT(problems_with_hosts("place 'tcp://a:7' { places = 5000 }"), HasSubstr("'places' must be 1 … 1024"));
}

TEST(CheckHosts, KeepsWhatIsTakenByOthersWhole) {
    const std::string two = "\nplace 'tcp://a:7'\nplace 'tcp://b:7'";
    const auto problems = [&](const std::string& taker) {
        return test::problems_of("a = Ambient {} b = Cache { a }" + taker +
                                     " box = Scene { 'b.pbrt' }\n"
                                     "image = RayTracer { sum, scene = box, film = { 8, 8 } }",
                                 parse_hosts("layout { b = 'sharded' }" + two, "hosts.lua"));
    };
    EXPECT_THAT(problems(" c = Reuse { of = b } sum = Combine { b, c }"),
                HasSubstr("layout of 'b': it can't be sharded, as 'c' takes all that it keeps"));
    EXPECT_EQ(problems(" sum = Combine { b }"), "");
}

TEST(CheckHosts, WantsStrategiesAndNodesThatThereAre) {
    EXPECT_THAT(problems_with_hosts("strategy = 'afinity'"),
                HasSubstr("hosts.lua:1: strategy: there is none called 'afinity' (did you mean 'affinity'?)"));
    EXPECT_THAT(problems_with_hosts("strategy { sly = 'fastest' }"),
                HasSubstr("strategy of 'sly': there is no node of that name (did you mean 'sky'?)"));
    EXPECT_THAT(problems_with_hosts("strategy { box = 'fastest' }"), HasSubstr("it is a scene, which nobody asks"));
}

TEST(CheckHosts, WantsLayoutsThatThereAreOfNodesThatHaveThem) {
    const std::string two = "\nplace 'tcp://a:7' { sky = 1, image = 1 }\nplace 'tcp://b:7' { sky = 1 }";
    EXPECT_EQ(problems_with_hosts("layout = 'sharded'" + two), "");
    EXPECT_EQ(problems_with_hosts("layout { sky = 'sharded' }" + two), "");
    EXPECT_THAT(problems_with_hosts("layout { sky = 'shared' }" + two),
                HasSubstr("hosts.lua:1: layout of 'sky': there is none called 'shared' (did you mean 'sharded'?)"));
    EXPECT_THAT(problems_with_hosts("layout { sly = 'sharded' }" + two),
                HasSubstr("layout of 'sly': there is no node of that name (did you mean 'sky'?)"));
    EXPECT_THAT(problems_with_hosts("layout { box = 'sharded' }" + two), HasSubstr("it is a scene, which nobody asks"));
    EXPECT_THAT(problems_with_hosts("layout { image = 'sharded' }" + two),
                HasSubstr("layout of 'image': a RayTracer can't be sharded (these can: Ambient, Cache)"));
}

TEST(CheckHosts, WantsTwoReplicasOrMoreOfWhatIsSharded) {
    EXPECT_THAT(problems_with_hosts("layout { sky = 'sharded' }\nplace 'tcp://a:7' { sky = 1, image = 1 }"),
                HasSubstr("it takes two replicas or more to share it, but this file has 1"));
    EXPECT_EQ(problems_with_hosts("layout { sky = 'sharded' }\nplace 'tcp://a:7'\nplace 'tcp://b:7'"), "")
        << "hosts with the whole network have one sector each";
}

TEST(Address, IsTakenApart) {
    const auto address = address_of("tcp://onyx1.lab:7777");
    ASSERT_TRUE(address);
    EXPECT_EQ(address->host, "onyx1.lab");
    EXPECT_EQ(address->port, 7777);
}

}  // namespace
}  // namespace lightnet::check_hosts_test
