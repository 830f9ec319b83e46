#include "core/runtime/remote_channel.hpp"

#include <gtest/gtest.h>

namespace lightnet {
namespace {

class RecordingCarrier final : public Carrier {
public:
    bool ask(const PlaceAt&, Message& message) override {
        if (refuse) return false;
        asked.push_back(std::move(message));
        return true;
    }
    void reply(Message) override {}
    std::optional<Message> receive() override { return std::nullopt; }
    void wait(std::chrono::nanoseconds) override {}
    void forget(const PlaceAt&) override { ++forgotten; }
    const Counters& counters() const override { return none; }

    std::vector<Message> asked;
    bool refuse = false;
    int forgotten = 0;
    Counters none;
};

struct Owner final : BundleOwner<Query> {
    void answered(const Bundle<Query>&, std::vector<Rgb>) override { ++answers; }
    void failed(const Bundle<Query>&, const std::string& why) override { failures.push_back(why); }
    void returned(Bundle<Query> bundle) override { back.push_back(bundle.number); }
    int answers = 0;
    std::vector<std::string> failures;
    std::vector<std::uint64_t> back;
};

class RemoteChannelTest : public ::testing::Test {
protected:
    void send(std::uint64_t number, std::size_t questions = 1) {
        channel.send({std::make_shared<const std::vector<Query>>(questions), &owner, number, 1});
    }
    Message reply_to(const Message& ask) {
        Message reply;
        reply.type = Message::Type::reply;
        reply.bundle = ask.bundle;
        reply.answers.resize(std::get<Questions<Query>>(ask.questions)->size());
        reply.load = {0, 1000};
        return reply;
    }
    RecordingCarrier carrier;
    Owner owner;
    Counters counters;
    RemoteChannel<Query> channel{carrier, {1, 0, 0, {"tcp://onyx1:7777", 0}}, Credit{2, 100}, counters};
};

TEST_F(RemoteChannelTest, HasCreditForSoManyBundlesAndGetsItBackWithTheReplies) {
    send(1), send(2);
    EXPECT_FALSE(channel.has_credit());
    auto reply = reply_to(carrier.asked[0]);
    channel.arrived(reply);
    EXPECT_TRUE(channel.has_credit());
    EXPECT_EQ(owner.answers, 1);
}

TEST_F(RemoteChannelTest, DropsAndCountsALateOrDoubledReply) {
    send(1);
    auto first = reply_to(carrier.asked[0]), second = reply_to(carrier.asked[0]);
    channel.arrived(first);
    channel.arrived(second);
    EXPECT_EQ(owner.answers, 1);
    EXPECT_EQ(counters.late_replies, 1u);
}

TEST_F(RemoteChannelTest, GivesEverythingBackInOrderWhenItsPlaceIsLost) {
    send(7), send(8);
    channel.close();
    EXPECT_EQ(owner.back, (std::vector<std::uint64_t>{7, 8}));
    EXPECT_FALSE(channel.has_credit());
    EXPECT_EQ(counters.asked_again, 2u);
    auto late = reply_to(carrier.asked[0]);
    channel.arrived(late);
    EXPECT_EQ(owner.answers, 0) << "the work is asked again elsewhere; this answer comes too late";
}

TEST_F(RemoteChannelTest, FailsABundleWhoseAnswerHasAWrongSize) {
    send(1, 3);
    auto reply = reply_to(carrier.asked[0]);
    reply.answers.pop_back();
    channel.arrived(reply);
    ASSERT_EQ(owner.failures.size(), 1u);
}

TEST_F(RemoteChannelTest, ExpectsCompletionFromOutstandingWorkFillLevelAndServiceTime) {
    send(1, 10);
    auto reply = reply_to(carrier.asked[0]);
    reply.load = {5, 2000};
    channel.arrived(reply);
    EXPECT_NEAR(channel.completion_time(10), (5 + 10) * 2e-6, 1e-12);
}

}  // namespace
}  // namespace lightnet
