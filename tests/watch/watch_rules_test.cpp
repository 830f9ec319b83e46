// Whom the watch server answers.
#include "tools/http/watch_rules.hpp"

#include <gtest/gtest.h>

namespace lightnet::watch_rules_test {
namespace {

TEST(WatchAddress, IsReadFromHostsAndPorts) {
    EXPECT_EQ(watch_address(""), (WatchAddress{"127.0.0.1", 0}));
    EXPECT_EQ(watch_address("8080"), (WatchAddress{"127.0.0.1", 8080}));
    EXPECT_EQ(watch_address("localhost:8080"), (WatchAddress{"127.0.0.1", 8080}));
    EXPECT_EQ(watch_address("0.0.0.0"), (WatchAddress{"0.0.0.0", 0}));
    EXPECT_EQ(watch_address("10.0.0.1:80"), (WatchAddress{"10.0.0.1", 80}));
    EXPECT_EQ(watch_address("[::1]:80"), (WatchAddress{"::1", 80}));
    EXPECT_EQ(watch_address("::1"), (WatchAddress{"::1", 0}));
    EXPECT_EQ(watch_address("[fe80::1%eth0]:80"), (WatchAddress{"fe80::1%eth0", 80}));
    EXPECT_EQ(watch_address("[::ffff:127.0.0.1]:80"), (WatchAddress{"127.0.0.1", 80}));
}

TEST(WatchAddress, IsNothingElse) {
    for (const auto* text :
         {"farm", "127.0.0.1:", "127.0.0.1:x", "127.0.0.1:70000", "http://127.0.0.1", "300.0.0.1", "-1"})
        EXPECT_EQ(watch_address(text), std::nullopt) << text;
}

TEST(ViewerAddress, MayHaveAName) {
    EXPECT_EQ(viewer_address("", 7), (WatchAddress{"127.0.0.1", 7}));
    EXPECT_EQ(viewer_address("desk", 7), (WatchAddress{"desk", 7}));
    EXPECT_EQ(viewer_address("desk.lab-2:99", 7), (WatchAddress{"desk.lab-2", 99}));
    for (const auto* text : {"desk:", "desk:x", "a/b", "300.0.0.1", ":99"})
        EXPECT_EQ(viewer_address(text, 7), std::nullopt) << text;
}

TEST(WatchUrl, IsWhatARunSays) {
    EXPECT_EQ(watch_url("http://127.0.0.1:40123/#3c1f"), (WatchUrl{{"127.0.0.1", 40123}, "3c1f"}));
    EXPECT_EQ(watch_url("http://farm:80"), (WatchUrl{{"farm", 80}, ""}));
    EXPECT_EQ(watch_url("http://[::1]:80/"), (WatchUrl{{"::1", 80}, ""}));
    for (const auto* text : {"", "http://", "http://farm", "https://farm:80/", "farm:80", "http://farm:x/"})
        EXPECT_EQ(watch_url(text), std::nullopt) << text;
}

TEST(WatchAddress, KnowsWhetherOthersCanReachIt) {
    EXPECT_TRUE(watch_address("127.0.0.1:8080")->stays_here());
    EXPECT_TRUE(watch_address("[::1]:8080")->stays_here());
    EXPECT_FALSE(watch_address("0.0.0.0:8080")->stays_here());
    EXPECT_FALSE(watch_address("[::]:8080")->stays_here());
}

TEST(WatchRules, KnowTheNamesOfTheirOwnServer) {
    const WatchAddress here{"127.0.0.1", 8080};
    for (const auto* name : {"127.0.0.1:8080", "localhost:8080", "[::1]:8080"})
        EXPECT_TRUE(is_own_host(name, here, "onyx")) << name;
    for (const auto* name :
         {"127.0.0.1", "127.0.0.1:80", "evil.example:8080", "10.0.0.1:8080", "onyx:8080", ":8080", ""})
        EXPECT_FALSE(is_own_host(name, here, "onyx")) << name;
}

TEST(WatchRules, KnowTheNameOfTheirMachineWhereOthersReachThem) {
    const WatchAddress everywhere{"0.0.0.0", 8080};
    for (const auto* name : {"127.0.0.1:8080", "10.0.0.1:8080", "onyx:8080", "[fe80::1]:8080"})
        EXPECT_TRUE(is_own_host(name, everywhere, "onyx")) << name;
    EXPECT_FALSE(is_own_host("evil.example:8080", everywhere, "onyx"));
}

TEST(WatchRules, TellPagesOfOthersFromTheirOwn) {
    EXPECT_TRUE(is_own_origin("", "127.0.0.1:8080"));
    EXPECT_TRUE(is_own_origin("http://127.0.0.1:8080", "127.0.0.1:8080"));
    EXPECT_TRUE(is_own_origin("https://127.0.0.1:8080", "127.0.0.1:8080"));
    for (const auto* origin : {"http://127.0.0.1:8081", "http://evil.example", "null", "127.0.0.1:8080", "file://"})
        EXPECT_FALSE(is_own_origin(origin, "127.0.0.1:8080")) << origin;
}

TEST(WatchToken, IsAnotherEachTimeAndKnownOnlyWhole) {
    const auto token = new_token();
    EXPECT_EQ(token.size(), 32u);
    EXPECT_NE(token, new_token());
    EXPECT_TRUE(same_token(token, token));
    EXPECT_FALSE(same_token(token.substr(1), token));
    EXPECT_FALSE(same_token(token + "0", token));
    EXPECT_FALSE(same_token("", token));
    EXPECT_FALSE(same_token("", ""));
}

}  // namespace
}  // namespace lightnet::watch_rules_test
