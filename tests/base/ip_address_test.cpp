// Addresses as people write them.
#include "core/base/ip_address.hpp"

#include <gtest/gtest.h>

namespace lightnet::ip_address_test {
namespace {

std::string text_of(const std::string& text) {
    const auto address = ip_address(text);
    return address ? address->text() : "none";
}

TEST(IpAddress, IsReadInBothFamilies) {
    EXPECT_EQ(text_of("10.0.0.1"), "10.0.0.1");
    EXPECT_EQ(text_of("[::1]"), "::1");
    EXPECT_EQ(text_of("fd00:0:0::7"), "fd00::7");
    EXPECT_EQ(text_of("fe80::1%eth0"), "fe80::1%eth0");
    EXPECT_EQ(text_of("[fe80::1%2]"), "fe80::1%2");
    EXPECT_EQ(text_of("::ffff:10.0.0.1"), "10.0.0.1") << "it is one of the old family";
    for (const auto* other :
         {"", "onyx1", "300.0.0.1", "127.1", "[10.0.0.1]", "fe80:::1", "::1%", "::1%a b", "[]", "*"})
        EXPECT_EQ(text_of(other), "none") << other;
}

TEST(IpAddress, KnowsHowFarItReaches) {
    for (const auto* own : {"127.0.0.1", "127.3.2.1", "::1", "::ffff:127.0.0.1"})
        EXPECT_TRUE(ip_address(own)->is_loopback()) << own;
    for (const auto* other : {"0.0.0.0", "::", "10.0.0.1", "fe80::1%eth0", "::ffff:10.0.0.1", "fd00::1", "128.0.0.1"})
        EXPECT_FALSE(ip_address(other)->is_loopback()) << other;
    for (const auto* all : {"0.0.0.0", "::", "::ffff:0.0.0.0"}) EXPECT_TRUE(ip_address(all)->is_unspecified()) << all;
    for (const auto* link : {"fe80::1", "febf::1%eth0", "169.254.3.4"})
        EXPECT_TRUE(ip_address(link)->is_link_local()) << link;
    EXPECT_FALSE(ip_address("fec0::1")->is_link_local());
}

TEST(IpAddress, IsToldFromNumbersThatAreNone) {
    for (const auto* mistaken : {"999.999.999.999", "10.0.0.256", "fe80:::1", "::g"})
        EXPECT_TRUE(is_mistaken_number(mistaken)) << mistaken;
    for (const auto* fine : {"10.0.0.1", "::1", "onyx1", "onyx1.lab.example.com", "127.1"})
        EXPECT_FALSE(is_mistaken_number(fine)) << fine;
}

TEST(TcpEndpoint, HasAddressesWithColonsInBrackets) {
    EXPECT_EQ(tcp_endpoint("tcp://onyx1:7777"), (TcpEndpoint{"onyx1", "7777"}));
    EXPECT_EQ(tcp_endpoint("tcp://[::1]:*"), (TcpEndpoint{"::1", "*"}));
    EXPECT_EQ(tcp_endpoint("tcp://[fe80::1%eth0]:7777")->text(), "tcp://[fe80::1%eth0]:7777");
    for (const auto* other : {"tcp://::1:7777", "tcp://[onyx1]:7777", "tcp://:7777", "tcp://onyx1", "tcp://a b:1",
                              "udp://onyx1:1", "tcp://onyx1:x", "tcp://[::1]", "tcp://a;b:1", "tcp://[::1:7777"})
        EXPECT_EQ(tcp_endpoint(other), std::nullopt) << other;
}

TEST(TcpEndpoint, IsTheSameHoweverItIsWritten) {
    EXPECT_EQ(usual_text("tcp://[0:0::1]:7777"), usual_text("tcp://[::1]:7777"));
    EXPECT_EQ(usual_text("tcp://[::ffff:10.0.0.1]:7777"), usual_text("tcp://10.0.0.1:7777"));
    EXPECT_EQ(usual_text("tcp://Onyx1.Lab:7777"), usual_text("tcp://onyx1.lab:7777"));
    EXPECT_EQ(usual_text("onyx1"), "onyx1");
}

}  // namespace
}  // namespace lightnet::ip_address_test
