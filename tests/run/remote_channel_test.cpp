#include "core/run/schedule/remote_channels.hpp"

#include <gtest/gtest.h>

#include <map>

namespace lightnet::remote_channel_test {
namespace {

class RecordingCarrier final : public Carrier {
public:
    bool ask(const PlaceAt& to, Message& message) override {
        if (refuse) return false;
        where.push_back(to);
        asked.push_back(std::move(message));
        return true;
    }
    void reply(Message) override {}
    std::optional<Message> receive() override { return std::nullopt; }
    void wait(std::chrono::nanoseconds) override {}
    void forget(const PlaceAt& place) override { forgotten.push_back(place); }
    const Counters& counters() const override { return none; }

    std::vector<PlaceAt> where, forgotten;
    std::vector<Message> asked;
    bool refuse = false;
    Counters none;
};

struct Owner final : BundleOwner<Query> {
    void answered(const Bundle<Query>& bundle, std::vector<Rgb>) override { answers.push_back(bundle.number); }
    void failed(const Bundle<Query>&, const Failure& failure) override { failures.push_back(failure.why); }
    void returned(Bundle<Query>) override {}
    std::vector<std::uint64_t> answers;
    std::vector<std::string> failures;
};

Message reply_for(const Message& ask) {
    Message reply;
    reply.type = Message::Type::reply;
    reply.channel = ask.channel, reply.bundle = ask.bundle;
    reply.answers.resize(std::get<Questions<Query>>(ask.questions)->size());
    reply.load = {7, 1000};
    return reply;
}

class RemoteChannelTest : public ::testing::Test {
protected:
    Bundle<Query> bundle(std::uint64_t number) {
        return {std::make_shared<const std::vector<Query>>(1), &owner, number, 1};
    }
    RecordingCarrier carrier;
    Owner owner;
    Counters counters;
};

// Else who answers would take a question of a place that was started anew for one of the place before it, and the other
// way round.
TEST_F(RemoteChannelTest, HasNumbersOfItsOwnForBundlesOfOnePlaceAfterTheOther) {
    RemoteChannel<Query> before{carrier, {.run = 1, .node = 3, .place = {}, .first_bundle = 1000}, {}, counters};
    RemoteChannel<Query> after{carrier, {.run = 1, .node = 3, .place = {}, .first_bundle = 5000}, {}, counters};
    EXPECT_TRUE(before.send(bundle(2)) && after.send(bundle(2)));
    EXPECT_NE(carrier.asked[0].bundle, carrier.asked[1].bundle);
    auto late = reply_for(carrier.asked[0]), reply = reply_for(carrier.asked[1]);
    after.arrived(late);
    after.arrived(reply);
    ASSERT_EQ(owner.answers.size(), 2u);
    EXPECT_NE(owner.answers[0], 2u) << "of the place before: nobody knows that number here";
    EXPECT_EQ(owner.answers[1], 2u);
}

TEST_F(RemoteChannelTest, BringsAnswersAndTheLoadOfTheAnswererBack) {
    RemoteChannel<Query> channel{carrier, {1, 0, 3, {"tcp://onyx1:7777", 0}, 5, 9}, {}, counters};
    EXPECT_TRUE(channel.send(bundle(5)));
    EXPECT_EQ(carrier.asked[0].node, 3u);
    EXPECT_EQ(carrier.asked[0].asker, 9u);
    auto reply = reply_for(carrier.asked[0]);
    channel.arrived(reply);
    EXPECT_EQ(owner.answers, (std::vector<std::uint64_t>{5}));
    EXPECT_EQ(channel.load(), (Load{7, 1000}));
}

TEST_F(RemoteChannelTest, DropsAndCountsWhatComesAfterItsPlaceWasLost) {
    RemoteChannel<Query> channel{carrier, {1, 0, 0, {"tcp://onyx1:7777", 0}, 5, 0}, {}, counters};
    channel.send(bundle(5));
    channel.close();
    auto reply = reply_for(carrier.asked[0]);
    channel.arrived(reply);
    EXPECT_TRUE(owner.answers.empty());
    EXPECT_EQ(counters.late_replies, 1u);
    EXPECT_EQ(carrier.forgotten, (std::vector<PlaceAt>{{"tcp://onyx1:7777", 0}}));
}

Plan plan_of(std::vector<PlaceAt> there, std::vector<std::uint32_t> holding) {
    Plan plan;
    plan.places = std::move(there);
    plan.places_of = {std::move(holding)};
    return plan;
}

TEST_F(RemoteChannelTest, AreOpenedAndClosedAsThePlanWantsIt) {
    const PlaceAt one{"one", 0}, two{"two", 0};
    RemoteChannels<Query> channels(carrier, 1, {}, counters);
    RemoteChannels<Query>::Edge edge{0, {}, {}};
    Multiplexer<Query> replicas;
    channels.connect(edge, replicas, plan_of({one, two}, {0, 1}));
    EXPECT_EQ(replicas.size(), 2u);
    channels.connect(edge, replicas, plan_of({two}, {0}));
    EXPECT_EQ(replicas.size(), 1u);
    EXPECT_EQ(carrier.forgotten, (std::vector<PlaceAt>{one}));
    replicas.send(bundle(1));
    ASSERT_EQ(carrier.where, (std::vector<PlaceAt>{two}));
    auto reply = reply_for(carrier.asked[0]);
    channels.arrived(reply);
    EXPECT_EQ(owner.answers, (std::vector<std::uint64_t>{1}));
}

TEST_F(RemoteChannelTest, ToAPlaceThatHoldsTheNodeNoMoreStaysOpenForItsAnswers) {
    const PlaceAt one{"one", 0}, two{"two", 0};
    RemoteChannels<Query> channels(carrier, 1, {}, counters);
    RemoteChannels<Query>::Edge edge{0, {}, {}};
    Multiplexer<Query> replicas;
    channels.connect(edge, replicas, plan_of({one}, {0}));
    replicas.send(bundle(1));
    channels.connect(edge, replicas, plan_of({one, two}, {1}));
    replicas.send(bundle(2));
    EXPECT_EQ(carrier.where, (std::vector<PlaceAt>{one, two}));
    auto reply = reply_for(carrier.asked[0]);
    channels.arrived(reply);
    EXPECT_EQ(owner.answers, (std::vector<std::uint64_t>{1}));
    EXPECT_EQ(counters.asked_again, 0u);
}

TEST_F(RemoteChannelTest, IsOneToEachOtherHostAndOneToEachPlaceBeside) {
    RemoteChannels<Query> channels(carrier, 1, {"own", 9}, counters);
    RemoteChannels<Query>::Edge edge{0, {2, 100, 1000}, {}};
    Multiplexer<Query> replicas;
    const Plan plan = plan_of({{"own", 0}, {"own", 1}, {"four", 0}, {"four", 1}, {"four", 2}, {"four", 3}, {"one", 5}},
                              {0, 1, 2, 3, 4, 5, 6});
    channels.connect(edge, replicas, plan);
    EXPECT_EQ(edge.known.size(), 4u) << "channels";
    EXPECT_EQ(replicas.size(), 4u);
    EXPECT_EQ(replicas.places(), 7u);
    EXPECT_EQ(replicas.credit(), (Credit{14, 700, 7000})) << "as much as the places together";
    for (std::uint64_t i = 1; i <= 14; ++i) replicas.send(bundle(i));
    std::map<PlaceAt, int> asked;
    for (const auto& where : carrier.where) ++asked[where];
    EXPECT_EQ(asked,
              (std::map<PlaceAt, int>{{{"own", 0}, 2}, {{"own", 1}, 2}, {{"four", any_place}, 8}, {{"one", 5}, 2}}))
        << "a host with one place for it has nothing to choose";
}

TEST_F(RemoteChannelTest, ToAHostLastsWhileItsPlacesChange) {
    RemoteChannels<Query> channels(carrier, 1, {}, counters);
    RemoteChannels<Query>::Edge edge{0, {1, 100, 1000}, {}};
    Multiplexer<Query> replicas;
    const std::vector<PlaceAt> there{{"host", 0}, {"host", 1}, {"host", 2}};
    channels.connect(edge, replicas, plan_of(there, {1}));
    replicas.send(bundle(1)), replicas.send(bundle(2));
    EXPECT_EQ(carrier.where, (std::vector<PlaceAt>{{"host", 1}}));
    channels.connect(edge, replicas, plan_of(there, {0, 1, 2}));
    replicas.send(bundle(3));
    EXPECT_EQ(carrier.where, (std::vector<PlaceAt>{{"host", 1}, {"host", any_place}, {"host", any_place}}));
    channels.connect(edge, replicas, plan_of(there, {2}));
    EXPECT_EQ(replicas.places(), 1u);
    for (auto& ask : carrier.asked) {
        auto reply = reply_for(ask);
        channels.arrived(reply);
    }
    EXPECT_EQ(owner.answers, (std::vector<std::uint64_t>{1, 2, 3}));
    EXPECT_EQ(counters.asked_again + counters.late_replies, 0u);
}

TEST_F(RemoteChannelTest, OfTwoKindsShareACarrier) {
    RemoteChannels<Query> first(carrier, 1, {}, counters), second(carrier, 1, {"", 0, 1u << 31}, counters);
    RemoteChannels<Query>::Edge edge{0, {}, {}}, other{0, {}, {}};
    Multiplexer<Query> replicas, others;
    first.connect(edge, replicas, plan_of({{"one", 0}}, {0}));
    second.connect(other, others, plan_of({{"one", 0}}, {0}));
    others.send(bundle(4));
    auto reply = reply_for(carrier.asked[0]);
    auto stray = reply;
    first.arrived(stray);
    EXPECT_TRUE(owner.answers.empty());
    second.arrived(reply);
    EXPECT_EQ(owner.answers, (std::vector<std::uint64_t>{4}));
}

}  // namespace
}  // namespace lightnet::remote_channel_test
