#include "core/run/master/epoch.hpp"

#include <gtest/gtest.h>

namespace lightnet::epoch_test {
namespace {

TEST(Epoch, KnowsItsRepliesFromThoseToTheOneBefore) {
    Epoch epoch;
    for (std::uint32_t i = 0; i < 2 * Epoch::count + 1; ++i) {
        const auto first = epoch.marked(0), last = epoch.marked(Epoch::most_channels - 1);
        ASSERT_TRUE(epoch.has(first) && epoch.has(last)) << i;
        EXPECT_EQ(Epoch::channel_of(first), 0u);
        EXPECT_EQ(Epoch::channel_of(last), Epoch::most_channels - 1);
        epoch.begin_next();
        ASSERT_FALSE(epoch.has(first) || epoch.has(last)) << i;
    }
}

TEST(Epoch, RefusesAChannelThatWouldBeTakenForAnotherEpochs) {
    const Epoch epoch;
    EXPECT_THROW(epoch.marked(Epoch::most_channels), Error);
    EXPECT_THROW(epoch.marked(1u << Epoch::channel_bits), Error);
}

TEST(Epoch, LeavesSomeChannelsToWhoLeadsAllMasters) {
    Epoch epoch;
    for (std::uint32_t i = 0; i <= Epoch::count; ++i, epoch.begin_next()) {
        ASSERT_FALSE(Epoch::is_own(epoch.marked(Epoch::most_channels - 1))) << i;
        ASSERT_FALSE(epoch.has(Epoch::own(0))) << i;
    }
    EXPECT_TRUE(Epoch::is_own(Epoch::own(0)) && Epoch::is_own(Epoch::own(Epoch::most_channels - 1)));
    EXPECT_EQ(Epoch::channel_of(Epoch::own(7)), 7u);
}

}  // namespace
}  // namespace lightnet::epoch_test
