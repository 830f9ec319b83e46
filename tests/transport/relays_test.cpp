// What the launcher passes on between hosts, and what it does with what it can't.
#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "transport/launcher/relays.hpp"
#include "transport/wire/relay_address.hpp"

namespace lightnet::relays_test {
namespace {

using packet::Header;
using packet::Type;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

Message ask() {
    Message message;
    message.run = 1, message.bundle = 7;
    message.questions = std::make_shared<const std::vector<Query>>(3);
    return message;
}

Message reply() {
    Message message = ask();
    message.type = Message::Type::reply;
    message.questions = {};
    message.answers.resize(3);
    return message;
}

Frames frames_of(const RelayAddress& address, const Message& message, std::uint32_t place = 0) {
    Frames frames;
    frames.emplace_back(seal(address));
    append(frames, packet::pack(message, place));
    return frames;
}

class RelaysTest : public ::testing::Test {
protected:
    Relays::Handlers handlers() {
        return {[this](const std::string& host, Frames& frames, std::uint32_t place) {
                    if (host != "there") return false;
                    passed_on = *unseal(bytes_of(frames[0]));
                    asked.push_back(passed_on.host + " asks place " + std::to_string(place));
                    return true;
                },
                [this](const RelayAddress& asker, Frames&) {
                    if (asker.host != "here") return false;
                    answered.push_back(asker.place);
                    return true;
                },
                [this](const std::string& host) { told.push_back(host); }, [this] { ++damaged; }};
    }
    // All who are told by then.
    std::vector<std::string> told_by(std::chrono::milliseconds time) {
        told.clear();
        relays.request_resends(begin + time);
        return told;
    }

    Counters counters;
    std::vector<std::string> asked, answered, told;
    RelayAddress passed_on;  // the last ask
    int damaged = 0;
    Relays relays{counters, handlers()};
    const Relays::Time begin = Relays::Time{} + std::chrono::hours(1);
};

TEST_F(RelaysTest, TellsTheAnswererWhoAsks) {
    auto frames = frames_of({"there", "p"}, ask(), 2);
    relays.forward("here", frames);
    EXPECT_THAT(asked, ElementsAre("here asks place 2"));
    EXPECT_GT(counters.relayed_bytes, 64u);
    EXPECT_FALSE(relays.waiting());
}

TEST_F(RelaysTest, BringsAReplyToThePlaceThatAsked) {
    auto frames = frames_of({"there", "p"}, ask());
    relays.forward("here", frames);
    frames = frames_of(passed_on, reply());
    relays.forward("there", frames);
    EXPECT_THAT(answered, ElementsAre("p"));
    EXPECT_THAT(told_by({}), IsEmpty());
}

TEST_F(RelaysTest, BringsNoReplyOfAHostThatWasNotAsked) {
    auto frames = frames_of({"there", "p"}, ask());
    relays.forward("here", frames);
    const auto answer = [&](const std::string& from, const RelayAddress& address, const Message& message) {
        auto reply = frames_of(address, message);
        relays.forward(from, reply);
    };
    answer("liar", passed_on, reply());  // who has overheard the address
    answer("there", {"here", "p"}, reply());
    answer("there", {"here", "q", passed_on.tag}, reply());
    auto other = reply();
    other.bundle = 8;
    answer("there", passed_on, other);
    other = reply();
    other.run = 2;
    answer("there", passed_on, other);
    other = reply();
    other.channel = 3;
    answer("there", passed_on, other);
    EXPECT_THAT(answered, IsEmpty());
    EXPECT_EQ(counters.broken_packets, 6u);
    Counters none;
    Relays next_run{none, handlers()};
    auto late = frames_of(passed_on, reply());
    next_run.forward("there", late);
    EXPECT_THAT(answered, IsEmpty()) << "each run has a key of its own";
}

TEST_F(RelaysTest, TellsTheAskerOfAHostThatIsGone) {
    auto frames = frames_of({"nowhere", "p"}, ask());
    relays.forward("here", frames);
    EXPECT_THAT(told_by({}), ElementsAre("here"));
    EXPECT_THAT(told_by(std::chrono::seconds(1)), IsEmpty()) << "once is enough";
}

TEST_F(RelaysTest, TellsTheAskerWhenItsAskArrivedDamaged) {
    Frames frames;
    frames.emplace_back(seal({"here", "p"}));
    frames.emplace_back();
    frames.emplace_back();
    relays.forward("there", frames);
    EXPECT_THAT(told_by({}), ElementsAre("here"));
}

TEST_F(RelaysTest, DoesNotTrustADamagedAddress) {
    auto frames = frames_of({"there", "p"}, ask());
    static_cast<char*>(frames[0].data())[0] ^= 1;
    relays.forward("here", frames);
    EXPECT_THAT(asked, IsEmpty());
    EXPECT_EQ(damaged, 1) << "it may have been the reply to anybody";
    EXPECT_EQ(counters.broken_packets, 1u);
    EXPECT_THAT(told_by({}), ElementsAre("here"));
}

TEST_F(RelaysTest, PassesNoControlMessagesOn) {
    Frames frames;
    frames.emplace_back(seal({"there", "p"}));
    append(frames, packet::pack(Type::end, 1, {}));
    relays.forward("here", frames);
    EXPECT_THAT(asked, IsEmpty());
    EXPECT_EQ(counters.broken_packets, 1u);
}

TEST_F(RelaysTest, SaysItNoMoreOftenThanIsUseful) {
    for (int i = 0; i < 3; ++i) {
        auto frames = frames_of({"nowhere", "p"}, ask());
        relays.forward("here", frames);
    }
    EXPECT_THAT(told_by({}), ElementsAre("here"));
    auto frames = frames_of({"nowhere", "p"}, ask());
    relays.forward("here", frames);
    EXPECT_THAT(told_by(std::chrono::milliseconds(10)), IsEmpty());
    EXPECT_TRUE(relays.waiting());
    EXPECT_THAT(told_by(std::chrono::milliseconds(200)), ElementsAre("here"));
}

TEST(RelayAddress, IsReadBackAndAnyFlippedBitIsNoticed) {
    const RelayAddress address{"onyx1", std::string("\0abc", 4), "tag"};
    const auto sealed = seal(address);
    EXPECT_EQ(unseal(std::as_bytes(std::span(sealed))), address);
    for (std::size_t bit = 0; bit < sealed.size() * 8; ++bit) {
        auto broken = sealed;
        broken[bit / 8] = static_cast<char>(broken[bit / 8] ^ (1 << bit % 8));
        EXPECT_NE(unseal(std::as_bytes(std::span(broken))), address) << bit;
    }
    for (std::size_t size = 0; size < sealed.size(); ++size)
        EXPECT_FALSE(unseal(std::as_bytes(std::span(sealed.data(), size)))) << size;
}

TEST(CallsDirectly, NeverFromNorToHostsThatDialledIn) {
    EXPECT_TRUE(calls_directly("tcp://a:1", "tcp://b:1"));
    EXPECT_FALSE(calls_directly("tcp://a:1", "onyx1"));
    EXPECT_FALSE(calls_directly("tcp://a:1", "")) << "the launcher's own places have no port";
    EXPECT_FALSE(calls_directly("tcp://a:1", "tcp://127.0.0.1:1")) << "that would be itself";
    EXPECT_TRUE(calls_directly("tcp://127.0.0.1:2", "tcp://127.0.0.1:1"));
}

}  // namespace
}  // namespace lightnet::relays_test
