// How the launcher keeps a host, with a line and a clock of the test's own.
#include <gmock/gmock.h>

#include <algorithm>
#include <deque>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "transport/launcher/remote_host.hpp"
#include "transport/zmq/socket.hpp"

namespace lightnet::remote_host_test {
namespace {

using packet::Fields;
using packet::Type;
using State = RemoteHost::State;
using std::chrono::milliseconds;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// What the launcher sends lies in `sent`; what `say` is given arrives.
class FakeConnection final : public HostConnection {
public:
    bool send(Frames& frames, bool) override {
        if (refuses) return false;
        sent.push_back(packet::peek_header(bytes_of(frames[frames.size() - 2]))->type);
        if (sent.back() == Type::mark && answers_marks)
            say(packet::pack(Type::marked, packet::peek_header(bytes_of(frames[0]))->bundle));
        if (sent.back() == Type::ping) said = packet::unpack_fields(bytes_of(frames[1]))->number("sent");
        return true;
    }
    std::optional<Frames> receive() override {
        if (arriving.empty()) return std::nullopt;
        auto frames = std::move(arriving.front());
        arriving.pop_front();
        return frames;
    }
    void renew() override { ++renewed; }
    void watch(Poll&) const override {}
    std::optional<Handshake> look_at_handshake() override { return std::exchange(handshake, std::nullopt); }
    std::optional<LineKeys> keys() const override { return line_keys; }

    void say(packet::Packet packet) { append(arriving.emplace_back(), std::move(packet)); }

    std::vector<Type> sent;
    std::uint64_t said = 0;  // messages so far, in the last ping
    std::deque<Frames> arriving;
    int renewed = 0;
    bool refuses = false, answers_marks = true;
    std::optional<Handshake> handshake;
    std::optional<LineKeys> line_keys;
};

class RemoteHostTest : public ::testing::Test {
protected:
    RemoteHostTest() {
        auto made = std::make_unique<FakeConnection>();
        line = made.get();
        link.emplace(offer, counters, "host", std::move(made));
    }
    void pass(milliseconds time) {
        now += time;
        while (link->receive(now, {[this](Message) { ++answers; }, [](HostLink&, Frames&) {}})) {
        }
        link->tick(now, [] { return std::optional<std::string>("{}"); });
    }
    void become_ready() {
        pass({});
        line->say(packet::pack(Type::welcome, 1, Fields{}.set("places", 2).set("process", 5)));
        pass({});
        line->say(packet::pack(Type::need, 1, {}));
        line->say(packet::pack(Type::ready, 1, {}));
        told_to_us = 2;
        pass({});
        ASSERT_EQ(link->state(), State::ready);
    }
    // The host answers a heartbeat: it has counted so many messages from us.
    void beat(std::uint64_t taken) {
        pass(milliseconds(401));
        line->say(packet::pack(Type::pong, 1,
                               Fields{}
                                   .set("process", 5)
                                   .set("run", 1)
                                   .set("line", 1)
                                   .set("sent", line->said)
                                   .set("taken", taken)
                                   .set("told", told_to_us)));
        pass({});
    }
    void fail_handshakes(Handshake how) {
        for (int i = 0; i < 3; ++i) {
            line->handshake = how;
            pass(milliseconds(10));
        }
    }
    bool ask() {
        Message message;
        message.run = 1;
        message.questions = std::make_shared<const std::vector<Query>>(1);
        return link->send(message, 0);
    }
    void answer() {
        Message message;
        message.run = 1, message.type = Message::Type::reply;
        message.answers.resize(1);
        line->say(packet::pack(message, 0));
    }

    RunOffer offer{1, "me", "isa", 0, "{}", {}};
    Counters counters;
    FakeConnection* line = nullptr;
    std::optional<RemoteHost> link;
    RemoteHost::Time now = RemoteHost::Time{} + std::chrono::hours(1);
    std::uint64_t told_to_us = 0;
    int answers = 0;
};

TEST_F(RemoteHostTest, GreetsBeginsAndIsReady) {
    become_ready();
    EXPECT_THAT(line->sent, ::testing::IsSupersetOf({Type::hello, Type::begin}));
    EXPECT_EQ(link->places(), 2u);
}

TEST_F(RemoteHostTest, CountsWhatAFullLineRefusesAndNotWhatACutOneDoes) {
    become_ready();
    line->refuses = true;
    EXPECT_FALSE(ask());
    EXPECT_EQ(counters.refused_sends, 0u) << "nothing was on its way that could have filled it";

    line->refuses = false;
    for (int i = 0; i < high_water_mark; ++i) {
        ASSERT_TRUE(ask());
        pass({});
    }
    line->refuses = true;
    EXPECT_FALSE(ask());
    EXPECT_EQ(counters.refused_sends, 1u);

    line->refuses = false;
    beat(high_water_mark);
    line->refuses = true;
    EXPECT_FALSE(ask());
    EXPECT_EQ(counters.refused_sends, 1u) << "all that was sent has arrived";
}

TEST_F(RemoteHostTest, LosesAHostThatDoesNotAnswerAndCallsItAnew) {
    become_ready();
    for (int i = 0; i < 4; ++i) pass(milliseconds(400));
    EXPECT_EQ(link->state(), State::calling);
    EXPECT_EQ(link->reason(), "it does not answer");
    EXPECT_EQ(line->renewed, 1);
    line->sent.clear();
    pass(milliseconds(200));
    EXPECT_THAT(line->sent, ::testing::Contains(Type::hello));
}

TEST_F(RemoteHostTest, SpeaksOfKeysWhenTheTwoEndsDiffer) {
    fail_handshakes(Handshake::mismatched);
    EXPECT_TRUE(link->unknown());
    EXPECT_THAT(link->reason(), HasSubstr("it asks for keys"));
}

TEST_F(RemoteHostTest, TakesAHostThatHangsUpForOneThatMayHaveAKeyOnlyWhereItExpectsOne) {
    fail_handshakes(Handshake::abandoned);
    EXPECT_FALSE(link->unknown());
    EXPECT_THAT(link->reason(), HasSubstr("breaks off before a word is said; if it has a key"));
    line->line_keys = LineKeys{KeyPair::random(), KeyPair::random().open};
    fail_handshakes(Handshake::abandoned);
    EXPECT_TRUE(link->unknown());
    EXPECT_THAT(link->reason(), HasSubstr("another key than expected"));
}

TEST_F(RemoteHostTest, SpeaksOfNoKeysWhereAHostIsTooBusyToSayAWord) {
    line->line_keys = LineKeys{KeyPair::random(), KeyPair::random().open};
    for (int i = 0; i < 5; ++i) fail_handshakes(Handshake::unanswered);
    EXPECT_FALSE(link->unknown());
    EXPECT_EQ(link->state(), State::calling);
    EXPECT_THAT(link->reason(), Not(HasSubstr("key")));
}

// Its cable was pulled.
TEST_F(RemoteHostTest, SpeaksOfNoKeysWhereAHostHasTakenPart) {
    for (const bool keyed : {false, true}) {
        if (keyed) line->line_keys = LineKeys{KeyPair::random(), KeyPair::random().open};
        become_ready();
        pass(milliseconds(1600));
        ASSERT_EQ(link->state(), State::calling);
        fail_handshakes(Handshake::abandoned);
        EXPECT_FALSE(link->unknown());
        EXPECT_THAT(link->reason(), AllOf(HasSubstr("its line may be cut"), Not(HasSubstr("key"))));
    }
}

TEST_F(RemoteHostTest, WaitsLongerForWhoseHeartbeatsCameLate) {
    become_ready();
    pass(milliseconds(1000));
    line->say(packet::pack(Type::pong, 1, Fields{}.set("process", 5).set("run", 1).set("line", 1).set("told", 2)));
    pass({});
    for (int i = 0; i < 9; ++i) pass(milliseconds(400));
    EXPECT_EQ(link->state(), State::ready) << "it is late on a machine that has much to do";
    pass(milliseconds(400));
    EXPECT_EQ(link->state(), State::calling) << "but not for ever";
}

TEST_F(RemoteHostTest, WaitsLongerForWhoIsBusyTakingIn) {
    line->answers_marks = false;
    become_ready();
    const auto asks = [&] { return std::count(line->sent.begin(), line->sent.end(), Type::ask_light); };
    for (int i = 0; i < 1000; ++i) ASSERT_TRUE(ask());
    EXPECT_LT(asks(), 1000) << "some wait until the line has taken what is under way";
    for (int i = 0; i < 6; ++i) pass(milliseconds(400));
    EXPECT_EQ(link->state(), State::ready) << "a heartbeat waits behind what was sent";
    for (int i = 0; i < 10; ++i) pass(milliseconds(400));
    EXPECT_EQ(link->state(), State::calling) << "but not for ever";
}

TEST_F(RemoteHostTest, TakesAPartOfAMessageForASignOfLife) {
    become_ready();
    const std::vector<std::byte> some(1000);
    for (std::uint64_t i = 0; i < 10; ++i) {
        line->say(packet::pack(1, packet::Part{i * some.size(), 1'000'000, some}));
        pass(milliseconds(1000));
        ASSERT_EQ(link->state(), State::ready);
    }
}

TEST_F(RemoteHostTest, SendsFilesInPiecesAsTheLineTakesThem) {
    const auto file = std::make_shared<const std::vector<std::byte>>(3'000'000);
    const auto hash = content_hash(*file);
    offer.blobs[hash] = file;
    pass({});
    line->say(packet::pack(Type::welcome, 1, Fields{}.set("places", 2).set("process", 5)));
    pass({});
    line->say(packet::pack(Type::need, 1, Fields{}.set("hashes", to_hex(hash))));
    pass({});
    EXPECT_GT(counters.file_bytes, 0u);
    EXPECT_LT(counters.file_bytes, 40'000u) << "nobody knows yet how fast the line is";
    for (int i = 0; i < 1000 && link->state() == State::sending; ++i) {
        line->say(packet::pack(Type::blob_taken, 1, Fields{}.set("hash", to_hex(hash))));
        pass(milliseconds(1));
    }
    EXPECT_EQ(link->state(), State::building);
    EXPECT_EQ(counters.file_bytes, file->size());
}

TEST_F(RemoteHostTest, KeepsAHostThatHasAllMessages) {
    become_ready();
    beat(0);
    ASSERT_TRUE(ask() && ask());
    answer();
    ++told_to_us;
    beat(2);
    beat(2);
    EXPECT_EQ(link->state(), State::ready);
    EXPECT_EQ(answers, 1);
}

TEST_F(RemoteHostTest, NoticesThatAnAskHasVanished) {
    become_ready();
    beat(0);
    ASSERT_TRUE(ask() && ask());
    beat(1);
    EXPECT_EQ(link->state(), State::calling);
    EXPECT_EQ(link->reason(), "a message to or from it was lost");
}

TEST_F(RemoteHostTest, NoticesThatAReplyHasVanished) {
    become_ready();
    beat(0);
    ASSERT_TRUE(ask());
    ++told_to_us;
    beat(1);
    EXPECT_EQ(link->state(), State::calling);
}

TEST_F(RemoteHostTest, CountsAnewAfterALoss) {
    become_ready();
    beat(0);
    ASSERT_TRUE(ask());
    beat(0);
    ASSERT_EQ(link->state(), State::calling);
    become_ready();
    beat(17);
    ASSERT_TRUE(ask());
    beat(18);
    EXPECT_EQ(link->state(), State::ready);
}

TEST_F(RemoteHostTest, TakesAnEmptyMessageForACut) {
    become_ready();
    line->arriving.push_back(empty_message());
    pass({});
    EXPECT_EQ(link->state(), State::calling);
    EXPECT_EQ(link->reason(), "its connection was cut");
}

TEST_F(RemoteHostTest, LosesAHostThatWasStartedAnew) {
    become_ready();
    line->say(packet::pack(Type::pong, 1, Fields{}.set("process", 6)));
    pass({});
    EXPECT_EQ(link->reason(), "it was started anew");
}

TEST_F(RemoteHostTest, LetsAHostLeaveWhenItHasAnsweredAll) {
    become_ready();
    line->say(packet::pack(Type::leaving, 1, {}));
    pass({});
    EXPECT_EQ(link->state(), State::leaving);
    EXPECT_TRUE(link->takes_part()) << "what it has is still to come";
    line->say(packet::pack(Type::ended, 1, Fields{}.set("tiles", 3)));
    pass({});
    EXPECT_EQ(link->state(), State::calling);
    EXPECT_EQ(link->take_ended()->tiles, 3u);
}

TEST_F(RemoteHostTest, KeepsAHostOutThatWasDrained) {
    become_ready();
    ASSERT_TRUE(link->drain());
    EXPECT_THAT(line->sent, ::testing::Contains(Type::leaving));
    line->say(packet::pack(Type::leaving, 1, {}));
    pass({});
    EXPECT_EQ(link->state(), State::leaving);
    line->say(packet::pack(Type::ended, 1, {}));
    pass({});
    EXPECT_EQ(link->state(), State::refused);
}

TEST_F(RemoteHostTest, KeepsAHostOutThatIsLostWhileItLeaves) {
    become_ready();
    ASSERT_TRUE(link->drain());
    for (int i = 0; i < 4; ++i) pass(milliseconds(400));
    EXPECT_EQ(link->state(), State::refused) << link->reason();
}

TEST_F(RemoteHostTest, KeepsAHostOutThatIsDrainedBeforeItIsReady) {
    pass({});
    line->say(packet::pack(Type::welcome, 1, Fields{}.set("places", 2).set("process", 5)));
    pass({});
    ASSERT_TRUE(link->drain());
    EXPECT_EQ(link->state(), State::refused);
    line->say(packet::pack(Type::need, 1, {}));
    line->say(packet::pack(Type::ready, 1, {}));
    pass({});
    EXPECT_EQ(link->state(), State::refused);
}

}  // namespace
}  // namespace lightnet::remote_host_test
