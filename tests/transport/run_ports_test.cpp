#include "transport/launcher/run_ports.hpp"

#include <gtest/gtest.h>

namespace lightnet {
namespace {

using std::chrono::seconds;
const RunPorts::Time begin{};

TEST(RunPorts, AreTriedOneAfterTheOther) {
    RunPorts ports;
    EXPECT_EQ(ports.next_after_refusal("7000,7001,7002", begin), 7001);
    EXPECT_EQ(ports.next_after_refusal("7001,7002,7000", begin), 7002);
    EXPECT_EQ(ports.next_after_refusal("7002,7000,7001", begin), std::nullopt) << "all are busy";
    EXPECT_EQ(ports.next_after_refusal("7002,7000,7001", begin), 7000) << "again, when there was time to wait";
}

TEST(RunPorts, AreNoneOfADaemonThatStandsAlone) {
    RunPorts ports;
    EXPECT_EQ(ports.next_after_refusal("", begin), std::nullopt);
    ports.call(begin);
    EXPECT_EQ(ports.next_if_silent(begin + seconds(60)), std::nullopt);
}

TEST(RunPorts, AreLeftWhereNobodyAnswers) {
    RunPorts ports;
    EXPECT_EQ(ports.next_after_refusal("7000,7001", begin), 7001);
    EXPECT_TRUE(ports.calls());
    EXPECT_EQ(ports.next_if_silent(begin + seconds(1)), std::nullopt);
    EXPECT_EQ(ports.next_if_silent(begin + seconds(3)), 7000);
    EXPECT_EQ(ports.next_if_silent(begin + seconds(4)), std::nullopt) << "that has just been called";
    ports.answered();
    EXPECT_FALSE(ports.calls());
    EXPECT_EQ(ports.next_if_silent(begin + seconds(60)), std::nullopt);
}

}  // namespace
}  // namespace lightnet
