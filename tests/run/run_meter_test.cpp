// Windows of a run, from what hosts have counted.
#include "core/run/forecast/run_meter.hpp"

#include <gtest/gtest.h>

namespace lightnet::run_meter_test {
namespace {

// image asks `soft`; 100 usual tiles of one block.
RunCosts small() {
    RunCosts costs;
    costs.nodes = {{"scene"}, {"soft", 1e-5}, {"image", 0.01}};
    costs.edges = {{2, 1, 1000, 60}};
    costs.order = {1, 2};
    costs.image = 2;
    costs.picture = {320, 320, 16, 32};
    return costs;
}

HostFigures counted(std::uint64_t times) {
    HostFigures figures;
    figures.places = {{60 * times, 10 * times, 10 * times, 20 * times}};
    figures.nodes.resize(3);
    figures.nodes[1].looks = 40 * times, figures.nodes[2].looks = 20 * times;
    figures.edges = {{500 * times}};
    figures.clock_ns = 7'000'000'000 + 1'000'000'000 * times;
    figures.processor_ns = 700'000'000 * times;
    return figures;
}

TEST(RunMeter, TellsWhatCameMeanwhile) {
    const auto costs = small();
    RunMeter meter(costs, {{2, 1}}, 2);
    for (const std::size_t host : {0, 1}) meter.see(host, true, counted(1));
    meter.next(0.1);
    meter.see(0, true, counted(3));
    meter.see(1, false, counted(2));
    const auto window = meter.next(0.3);
    ASSERT_EQ(window.hosts.size(), 2u);
    EXPECT_TRUE(window.hosts[0].there);
    EXPECT_FALSE(window.hosts[1].there);
    EXPECT_DOUBLE_EQ(window.hosts[0].seconds, 2);
    EXPECT_DOUBLE_EQ(window.hosts[0].processor, 1.4);
    EXPECT_DOUBLE_EQ(window.hosts[0].busy[1], 0.4);
    EXPECT_DOUBLE_EQ(window.hosts[0].busy[2], 0.2);
    EXPECT_DOUBLE_EQ(window.hosts[0].own, 0.1);
    EXPECT_DOUBLE_EQ(window.questions[0], 1500);
    EXPECT_NEAR(window.blocks, 20, 1e-9);
    EXPECT_DOUBLE_EQ(window.left, 0.7);
}

TEST(RunMeter, KnowsNothingOfAHostThatSaysNothing) {
    const auto costs = small();
    RunMeter meter(costs, {{2, 1}}, 1);
    EXPECT_EQ(meter.next(0).hosts[0].seconds, 0);
    meter.see(0, true, counted(1));
    EXPECT_EQ(meter.next(0).hosts[0].seconds, 0) << "nobody knows when it began";
    EXPECT_EQ(meter.next(0).hosts[0].seconds, 0) << "nothing new";
}

TEST(RunMeter, BeginsAnewWithAHostThatDoes) {
    const auto costs = small();
    RunMeter meter(costs, {{2, 1}}, 1);
    meter.see(0, true, counted(5));
    meter.next(0.5);
    meter.see(0, true, counted(1));
    const auto window = meter.next(0.2);
    EXPECT_EQ(window.hosts[0].seconds, 0);
    EXPECT_EQ(window.questions[0], 0);
    EXPECT_EQ(window.blocks, 0) << "what was in doubt is done again";
    meter.see(0, true, counted(2));
    EXPECT_DOUBLE_EQ(meter.next(0.3).hosts[0].seconds, 1);
}

TEST(RunMeter, IsNotMisledByFiguresOfAnotherShape) {
    const auto costs = small();
    RunMeter meter(costs, {{2, 1}}, 1);
    auto odd = counted(1);
    odd.nodes.resize(9), odd.edges.resize(7);
    meter.see(0, true, odd);
    meter.next(0);
    odd = counted(2);
    odd.nodes.resize(1), odd.edges.clear();
    meter.see(0, true, odd);
    EXPECT_EQ(meter.next(0).hosts[0].busy.size(), 3u);
}

}  // namespace
}  // namespace lightnet::run_meter_test
