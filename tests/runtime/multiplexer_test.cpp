#include "core/runtime/multiplexer.hpp"

#include <gtest/gtest.h>

#include "tests/support/fake_channel.hpp"

namespace lightnet {
namespace {

using test::FakeChannel;

Bundle<Query> bundle_of(std::size_t questions) {
    return {std::make_shared<const std::vector<Query>>(questions), nullptr, 0, 1};
}

TEST(Multiplexer, AsksTheReplicaThatWillFinishFirst) {
    FakeChannel<Query> slow(1000, 4.0), fast(1000, 1.0);
    Multiplexer<Query> replicas({&slow, &fast});
    for (int i = 0; i < 10; ++i) replicas.send(bundle_of(1));
    EXPECT_EQ(slow.sent.size(), 2u);
    EXPECT_EQ(fast.sent.size(), 8u);
}

TEST(Multiplexer, PassesOverReplicasWithoutCredit) {
    FakeChannel<Query> full(0), free(1);
    Multiplexer<Query> replicas({&full, &free});
    EXPECT_TRUE(replicas.has_credit());
    EXPECT_TRUE(replicas.send(bundle_of(1)));
    EXPECT_EQ(free.sent.size(), 1u);
    EXPECT_FALSE(replicas.has_credit());
}

TEST(Multiplexer, TriesTheNextReplicaWhenOneRefuses) {
    FakeChannel<Query> broken, good(1000, 5.0);
    broken.refuse = true;
    Multiplexer<Query> replicas({&broken, &good});
    EXPECT_TRUE(replicas.send(bundle_of(1)));
    EXPECT_EQ(good.sent.size(), 1u);
}

TEST(Multiplexer, IsItselfAChannelAndNests) {
    FakeChannel<Query> a(1000, 1.0), b(1000, 1.0), c(1000, 1.0);
    Multiplexer<Query> pair({&a, &b});
    Multiplexer<Query> all({&pair, &c});
    for (int i = 0; i < 9; ++i) all.send(bundle_of(1));
    EXPECT_EQ(all.bundles_outstanding(), 9u);
    EXPECT_EQ(a.sent.size(), 3u);
    EXPECT_EQ(b.sent.size(), 3u);
    EXPECT_EQ(c.sent.size(), 3u);
}

TEST(Multiplexer, ServesRenderingAsItServesLight) {
    FakeChannel<Tile> only;
    Multiplexer<Tile> replicas({&only});
    EXPECT_TRUE(replicas.send({std::make_shared<const std::vector<Tile>>(1), nullptr, 0, 1}));
    EXPECT_EQ(only.sent.size(), 1u);
}

}  // namespace
}  // namespace lightnet
