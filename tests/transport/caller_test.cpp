// Doors and those who call them, by numbers of both families and by names.
#include "transport/zmq/caller.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zmq.h>

#include "core/base/error.hpp"
#include "tests/support/fake_names.hpp"
#include "tests/support/slowdown.hpp"
#include "transport/address/listening.hpp"
#include "transport/zmq/doorkeeper.hpp"

namespace lightnet::caller_test {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class CallerTest : public ::testing::Test {
protected:
    ~CallerTest() override { names->end(); }

    Socket open(const std::string& endpoint) const {
        auto door = door_socket(context);
        listen(door, context, endpoint);
        return door;
    }
    // Does the door hear, within the time, what the caller says again and again? A word on a line that is cut is lost.
    static bool reaches(Caller& caller, Socket& door, std::chrono::milliseconds most = test::slowdown * 10s) {
        auto said = Clock::time_point::min();
        for (const auto end = Clock::now() + most; Clock::now() < end;) {
            Poll poll;
            caller.watch(poll);
            poll.add(door);
            poll.wait(5ms);
            caller.tick(Clock::now());
            Frames word;
            word.emplace_back("a word");
            if (said < Clock::now() - 300ms && caller.send(word)) said = Clock::now();
            while (const auto heard = door.receive())
                if (text_of(heard->back()) == "a word") return true;
        }
        return false;
    }
    static std::string at_name(const std::string& name, const Socket& door) {
        return TcpEndpoint{name, tcp_endpoint(door.endpoint())->port}.text();
    }
    static bool has_six() {
        try {
            ListeningPort(*ip_address("::1"), 0);
            return true;
        } catch (const std::system_error&) {
            return false;
        }
    }

    std::shared_ptr<test::FakeNames> names = std::make_shared<test::FakeNames>();
    const SocketContext context{1, names};
};

TEST(HandshakeWatch, TellsWhoSaysNothingFromWhoHangsUp) {
    HandshakeWatch watch;
    const Clock::time_point start{};
    const SocketEvent connected{ZMQ_EVENT_CONNECTED}, failed{ZMQ_EVENT_HANDSHAKE_FAILED_NO_DETAIL};
    EXPECT_EQ(watch.see(failed, start), Handshake::abandoned);
    EXPECT_EQ(watch.see(connected, start), std::nullopt);
    EXPECT_EQ(watch.see(failed, start + 300ms), Handshake::abandoned);
    EXPECT_EQ(watch.see(connected, start + 1s), std::nullopt);
    EXPECT_EQ(watch.see(failed, start + 1s + handshake_patience), Handshake::unanswered);
    EXPECT_EQ(watch.see({ZMQ_EVENT_HANDSHAKE_FAILED_AUTH}, start + 9s), Handshake::refused);
}

TEST_F(CallerTest, TriesAllAddressesOfAName) {
    auto door = open("tcp://127.0.0.3:*");
    names->put("two.lab", {"127.0.0.1", "127.0.0.3"});
    Caller caller(context, at_name("two.lab", door), std::nullopt);
    EXPECT_EQ(caller.answering_at(), "");
    EXPECT_TRUE(reaches(caller, door));
    for (const auto end = Clock::now() + 10s; Clock::now() < end && caller.answering_at().empty();)
        caller.tick(Clock::now());
    EXPECT_EQ(caller.answering_at(), door.endpoint());
    EXPECT_EQ(caller.trouble(), "");
}

TEST_F(CallerTest, BeginsNextTimeWhereSomebodyAnswered) {
    auto door = open("tcp://127.0.0.3:*");
    names->put("two.lab", {"127.0.0.1", "127.0.0.3"});
    Caller first(context, at_name("two.lab", door), std::nullopt);
    ASSERT_TRUE(reaches(first, door));
    for (const auto end = Clock::now() + 10s; Clock::now() < end && first.answering_at().empty();)
        first.tick(Clock::now());
    EXPECT_EQ(context.names().remembered(at_name("two.lab", door)), ip_address("127.0.0.3"));
}

TEST_F(CallerTest, FollowsANameThatMoves) {
    auto door = std::make_optional(open("tcp://127.0.0.1:*"));
    const auto endpoint = at_name("moving.lab", *door);
    names->put("moving.lab", {"127.0.0.1"});
    Caller caller(context, endpoint, std::nullopt);
    ASSERT_TRUE(reaches(caller, *door));
    const auto port = tcp_endpoint(endpoint)->port;
    door.reset();
    names->put("moving.lab", {"127.0.0.4"});
    auto next = open("tcp://127.0.0.4:" + port);
    EXPECT_TRUE(reaches(caller, next, test::slowdown * 20s));
}

TEST_F(CallerTest, IsNotHeldUpByANameOfWhichNobodySaysAnything) {
    names->silence("silent.lab");
    auto door = open("tcp://127.0.0.1:*");
    Caller silent(context, "tcp://silent.lab:7777", std::nullopt), well(context, door.endpoint(), std::nullopt);
    silent.tick(Clock::now());
    EXPECT_TRUE(reaches(well, door));
    EXPECT_FALSE(silent.can_send());
    EXPECT_THAT(silent.trouble(), HasSubstr("'silent.lab'"));
}

TEST_F(CallerTest, SaysWhichNameIsGoneAndFindsItWhenItComes) {
    auto door = open("tcp://127.0.0.1:*");
    Caller caller(context, at_name("late.lab", door), std::nullopt);
    const auto end = Clock::now() + test::slowdown * 10s;
    while (Clock::now() < end && caller.trouble().find("no host") == std::string::npos) caller.tick(Clock::now());
    EXPECT_EQ(caller.trouble(), "no host is called 'late.lab'");
    names->put("late.lab", {"127.0.0.1"});
    EXPECT_TRUE(reaches(caller, door, test::slowdown * 20s));
}

TEST_F(CallerTest, ReachesDoorsOfBothFamilies) {
    if (!has_six()) GTEST_SKIP() << "no IPv6 here";
    auto six = open("tcp://[::1]:*"), both = open("tcp://[::]:*"), any = open("tcp://*:*");
    EXPECT_THAT(six.endpoint(), StartsWith("tcp://[::1]:"));
    Caller to_six(context, six.endpoint(), std::nullopt);
    EXPECT_TRUE(reaches(to_six, six));
    for (auto* door : {&both, &any})
        for (const auto* host : {"::1", "127.0.0.1"}) {
            Caller caller(context, at_name(host, *door), std::nullopt);
            EXPECT_TRUE(reaches(caller, *door)) << door->endpoint() << " by " << host;
        }
}

TEST_F(CallerTest, ReachesADoorAtTheNameOfThisMachine) {
    auto door = open("tcp://localhost:*");
    EXPECT_THAT(door.endpoint(), AnyOf(StartsWith("tcp://127.0.0.1:"), StartsWith("tcp://[::1]:")));
    for (const auto* host : {"127.0.0.1", "localhost"}) {
        Caller caller(context, at_name(host, door), std::nullopt);
        EXPECT_TRUE(reaches(caller, door)) << host;
    }
    if (!has_six()) return;
    Caller by_six(context, at_name("::1", door), std::nullopt);
    EXPECT_TRUE(reaches(by_six, door));
}

TEST_F(CallerTest, DoorsThatAskForKeysAreTriedInBothFamilies) {
    if (!has_six()) GTEST_SKIP() << "no IPv6 here";
    for (const auto* endpoint : {"tcp://[::1]:*", "tcp://[::]:*", "tcp://localhost:*"}) {
        const SocketContext own;
        auto door = door_socket(own);
        const auto key = KeyPair::random();
        Doorkeeper keeper(own, Doorkeeper::Keys{key, [](const PublicKey&) { return false; }});
        keeper.guard(door);
        listen(door, own, endpoint);
        EXPECT_NO_THROW(keeper.try_out(door)) << endpoint;
    }
}

std::string why_not(const SocketContext& context, const std::string& endpoint) {
    auto door = door_socket(context);
    try {
        listen(door, context, endpoint);
        return {};
    } catch (const Error& error) {
        return error.what();
    }
}

TEST_F(CallerTest, DoorsSayWhyTheyCannotListen) {
    EXPECT_THAT(why_not(context, "tcp://192.0.2.77:7777"),
                HasSubstr("no network card of this machine has that address"));
    EXPECT_THAT(why_not(context, "tcp://nowhere.lab:7777"), HasSubstr("no host is called 'nowhere.lab'"));
    EXPECT_THAT(why_not(context, "tcp://[fe80::1%nocard0]:7777"), HasSubstr("there is no such network card"));
    names->put("far.lab", {"192.0.2.77"});
    EXPECT_THAT(why_not(context, "tcp://far.lab:*"), HasSubstr("no network card of this machine has that address"));
    auto taken = open("tcp://127.0.0.1:*");
    EXPECT_THAT(why_not(context, taken.endpoint()), HasSubstr("in use (choose another port"));
    EXPECT_EQ(why_not(context, "tcp://lo:*"), "") << "the name of a card";
}

TEST_F(CallerTest, NoNameReachesTheLibrary) {
    auto socket = door_socket(context);
    EXPECT_THROW(socket.bind("tcp://localhost:*"), SocketError);
    EXPECT_THROW(asking_socket(context, "tcp://onyx1:7777"), SocketError);
    EXPECT_THROW(Caller(context, "tcp://::1:7777", std::nullopt), SocketError);
}

}  // namespace
}  // namespace lightnet::caller_test
