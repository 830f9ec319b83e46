// What can only be reached from this machine.
#include "transport/reach.hpp"

#include <gtest/gtest.h>

namespace lightnet::reach_test {
namespace {

TEST(Reach, OfLoopbackEndsAtThisMachine) {
    for (const auto* own :
         {"tcp://127.0.0.1:7777", "tcp://127.3.2.1:*", "tcp://localhost:1", "tcp://[::1]:7777", "ipc:///tmp/somewhere"})
        EXPECT_TRUE(stays_on_this_machine(own)) << own;
}

TEST(Reach, OfEverythingElseDoesNot) {
    for (const auto* other : {"tcp://0.0.0.0:7777", "tcp://*:7777", "tcp://10.0.0.1:7777", "tcp://onyx1:7777",
                              "tcp://127.0.0.1.example.com:7777", "tcp://127.example.com:1", "127.0.0.1:7777", "foo"})
        EXPECT_FALSE(stays_on_this_machine(other)) << other;
}

}  // namespace
}  // namespace lightnet::reach_test
