// The tail of questions about light, on a simulated clock.
#include "tests/run/simulated_light.hpp"

#include <gtest/gtest.h>

namespace lightnet::test::simulated_light_test {
namespace {

double doubled(const LightStory& story) { return double(story.answered - story.asked) / double(story.asked); }

// Over many seeds: how long it takes with the tail asked twice, as a part of how long it takes without.
double gain(LightWorld world) {
    double with = 0, without = 0;
    for (world.seed = 1; world.seed <= 20; ++world.seed) {
        world.double_tail = true;
        with += SimulatedLight(world).play().seconds;
        world.double_tail = false;
        without += SimulatedLight(world).play().seconds;
    }
    return with / without;
}

TEST(SimulatedLight, EndsSoonerWhereOneReplicaHasBecomeSlow) {
    LightWorld world;
    world.asks = 50;
    world.slower_from = 0.9, world.slower = 20;
    EXPECT_LT(gain(world), 0.9);
}

TEST(SimulatedLight, IsNoSlowerForItWhereAllAreAlike) {
    LightWorld world;
    world.asks = 50;
    EXPECT_LT(gain(world), 1.02);
}

TEST(SimulatedLight, IsHardlyEverAskedTwiceWhileWorkGoesOn) {
    for (const std::size_t askers : {1, 4})
        for (const std::vector<double>& slowness :
             {std::vector<double>{1, 1}, std::vector<double>{1, 1, 1, 1, 1, 1, 1, 1}, std::vector<double>{1, 2, 4, 8}})
            for (std::uint64_t seed = 1; seed <= 2; ++seed) {
                LightWorld world;
                world.seed = seed, world.askers = askers, world.slowness = slowness;
                EXPECT_LT(doubled(SimulatedLight(world).play()), 0.011) << askers << " askers, " << slowness.size();
            }
}

}  // namespace
}  // namespace lightnet::test::simulated_light_test
