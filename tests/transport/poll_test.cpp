#include "transport/lines/poll.hpp"

#include <gtest/gtest.h>
#include <sys/eventfd.h>
#include <unistd.h>
#include <zmq.h>

#include <chrono>
#include <cstdint>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace lightnet::poll_test {
namespace {

using namespace std::chrono_literals;

constexpr const char* here = "inproc://poll-test";

/// Two sockets of this process that are connected to each other, which needs no thread between them.
struct Pair {
    SocketContext context;
    Socket one{context, ZMQ_PAIR}, other{context, ZMQ_PAIR};
    Pair() {
        one.bind(here);
        other.connect(here);
    }
};

void say(Socket& socket, const char* word) {
    Frames frames;
    frames.emplace_back(std::string(word));
    ASSERT_TRUE(socket.send(frames));
}

bool readable(const Socket& socket, std::chrono::milliseconds most = 0ms) {
    Poll poll;
    poll.add(socket);
    poll.wait(most);
    return poll.readable(0);
}

TEST(Poll, FindsWhatCameBeforeAndWhatComesAfterASocketWasFoundEmpty) {
    Pair pair;
    EXPECT_FALSE(readable(pair.one));
    EXPECT_TRUE(pair.one.quiet());
    say(pair.other, "a");
    EXPECT_TRUE(readable(pair.one));
    EXPECT_FALSE(pair.one.quiet());
    EXPECT_TRUE(readable(pair.one)) << "nobody took it";
    EXPECT_TRUE(pair.one.receive());
    EXPECT_FALSE(readable(pair.one));
    say(pair.other, "b");
    say(pair.other, "c");
    EXPECT_TRUE(pair.one.receive());
    EXPECT_TRUE(readable(pair.one)) << "there were two, and one descriptor told of both";
}

// The library takes notice of a message while it does something else, and its descriptor doesn't tell of that any more.
TEST(Poll, MissesNothingThatCameWhileASocketDidSomethingElse) {
    const auto finds_it_after = [](const auto& does) {
        Pair pair;
        EXPECT_FALSE(readable(pair.one));
        say(pair.other, "a");
        does(pair.one);
        return readable(pair.one, 1s);
    };
    EXPECT_TRUE(finds_it_after([](Socket& one) {
        std::this_thread::sleep_for(10ms);  // sending looks at what has come now and then only
        say(one, "back");
    }));
    EXPECT_TRUE(finds_it_after([](Socket& one) { EXPECT_TRUE(one.can_send()); }));
    EXPECT_TRUE(finds_it_after([](Socket& one) { one.bind("inproc://poll-test-2"); }));
    EXPECT_TRUE(finds_it_after([](Socket& one) {
        Socket moved(std::move(one));
        EXPECT_TRUE(readable(moved));
        one = std::move(moved);
    }));
}

TEST(Poll, WaitsForSocketsAndDescriptorsTogether) {
    Pair pair;
    const int descriptor = eventfd(0, EFD_CLOEXEC);
    ASSERT_GE(descriptor, 0);
    const auto look = [&](std::chrono::milliseconds most) {
        Poll poll;
        poll.add(pair.one);
        poll.add(descriptor);
        poll.wait(most);
        return std::pair(poll.readable(0), poll.readable(1));
    };
    EXPECT_EQ(look(0ms), std::pair(false, false));
    const auto begun = std::chrono::steady_clock::now();
    EXPECT_EQ(look(30ms), std::pair(false, false));
    EXPECT_GE(std::chrono::steady_clock::now() - begun, 30ms);
    const std::uint64_t one = 1;
    ASSERT_EQ(write(descriptor, &one, sizeof one), ssize_t(sizeof one));
    EXPECT_EQ(look(10s), std::pair(false, true));
    say(pair.other, "a");
    EXPECT_EQ(look(10s), std::pair(true, true)) << "what is found first hides nothing";
    close(descriptor);
}

TEST(Poll, IsWokenByAnotherThread) {
    Pair pair;
    EXPECT_FALSE(readable(pair.one));
    std::jthread later([&] {
        std::this_thread::sleep_for(20ms);
        say(pair.other, "a");
    });
    EXPECT_TRUE(readable(pair.one, 10s));
}

// Both ends send in bursts and take what comes, so that all that a socket does falls into all that comes: a wake that
// is lost would make one of them wait until its time is up.
TEST(Poll, LosesNoWakeWhereBothEndsSendAndTake) {
    constexpr int messages = 20'000;
    constexpr auto most = 5s;
    const SocketContext context;
    auto door = answering_socket(context);
    door.bind("tcp://127.0.0.1:*");
    auto caller = asking_socket(context, door.endpoint());
    const auto answers = [&] {
        std::vector<Frames> waiting;
        for (int taken = 0, sent = 0; sent < messages;) {
            if (auto frames = door.receive()) {  // one for each wait, and most waits follow no sending
                waiting.push_back(std::move(*frames));
                ++taken;
            }
            if (taken % 5 == 0)
                while (!waiting.empty() && door.send(waiting.back())) waiting.pop_back(), ++sent;
            if (sent == messages) return true;
            Poll poll;
            poll.add(door);
            poll.wait(most);
            if (!poll.readable(0)) return false;
        }
        return true;
    };
    bool answered = false;
    std::jthread other([&] { answered = answers(); });
    int sent = 0, taken = 0;
    while (taken < messages) {
        while (caller.receive()) ++taken;
        if (sent % 97 == 0) std::this_thread::sleep_for(2ms);  // answers come, and sending takes note of them
        for (int burst = sent % 11; burst >= 0 && sent < messages && sent - taken < 50; --burst) {
            Frames frames;
            frames.emplace_back(std::to_string(sent));
            if (!caller.send(frames)) break;
            ++sent;
        }
        if (taken == messages || sent - taken < 45) continue;
        Poll poll;
        poll.add(caller);
        poll.wait(most);
        ASSERT_TRUE(poll.readable(0)) << "after " << taken << " answers";
    }
    other.join();
    EXPECT_TRUE(answered);
}

}  // namespace
}  // namespace lightnet::poll_test
