// What can only be reached from this machine.
#include "transport/wire/loopback.hpp"

#include <gtest/gtest.h>

namespace lightnet::loopback_test {
namespace {

TEST(Reach, OfLoopbackEndsAtThisMachine) {
    for (const auto* own : {"tcp://127.0.0.1:7777", "tcp://127.3.2.1:*", "tcp://localhost:1", "tcp://[::1]:7777",
                            "tcp://[::1]:*", "tcp://[::ffff:127.0.0.1]:7777", "ipc:///tmp/somewhere"})
        EXPECT_TRUE(stays_on_this_machine(own)) << own;
}

TEST(Reach, OfEverythingElseDoesNot) {
    for (const auto* other : {"tcp://0.0.0.0:7777", "tcp://*:7777", "tcp://10.0.0.1:7777", "tcp://onyx1:7777",
                              "tcp://127.0.0.1.example.com:7777", "tcp://127.example.com:1", "127.0.0.1:7777", "foo",
                              "tcp://[::]:7777", "tcp://[::ffff:0.0.0.0]:7777", "tcp://[fe80::1%lo]:7777",
                              "tcp://[fd00::1]:7777", "tcp://::1:7777", "tcp://localhost.lab:1"})
        EXPECT_FALSE(stays_on_this_machine(other)) << other;
}

}  // namespace
}  // namespace lightnet::loopback_test
