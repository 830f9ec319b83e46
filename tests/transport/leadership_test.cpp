// Leadership over a host's sockets: one leads at a time, and somebody does soon.
#include "transport/lines/leadership.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace lightnet::leadership_test {
namespace {

using namespace std::chrono_literals;
using Rest = Leadership::Rest;

constexpr auto long_rest = 20'000ms;  // nothing below may take so long

Frames word(const std::string& text) {
    Frames frames;
    frames.emplace_back(text);
    return frames;
}

/// A door that is a queue: "host" is for the host's own thread, all else for places.
class Door final : public Leadership::Led {
public:
    void watch(Poll& poll) const override { poll.add(door); }
    bool take_in() override {
        const Alone alone(*this);
        if (left || !door.empty()) {
            auto frames = left ? std::exchange(left, std::nullopt) : door.pop();
            if (text_of(frames->front()) == "host") return left = std::move(frames), false;
            if (text_of(frames->front()) == "fault") throw std::runtime_error("no memory is left");
            ++taken;
            replies.push_always(*frames);
        }
        return true;
    }
    void send() override {
        const Alone alone(*this);
        while (replies.pop()) ++sent;
    }
    void push(const std::string& text) {
        auto frames = word(text);
        door.push_always(frames);
    }

    mutable FrameQueue door;
    FrameQueue replies;
    std::optional<Frames> left;  // to the host's own thread
    std::atomic<int> taken{0}, sent{0}, together{0};

private:
    struct Alone {
        explicit Alone(Door& its) : door(its) { door.together += door.inside.exchange(true); }
        ~Alone() { door.inside = false; }
        Door& door;
    };
    std::atomic<bool> inside{false};
};

class LeadershipTest : public ::testing::Test {
protected:
    LeadershipTest() { leadership.take(); }
    ~LeadershipTest() override { leadership.give_back(); }

    void wait_once(std::chrono::milliseconds most) {
        {
            Leadership::Turn turn(&leadership, &door.replies);
            Poll poll;
            poll.add(never.handle());
            turn.watch(poll);
            poll.wait(most);
            turn.look(poll);
        }
        leadership.send(door.replies);
    }
    Rest rest(std::chrono::milliseconds most = long_rest) {
        return leadership.rest([&](Poll& poll) { poll.add(others.handle()); }, door.replies, most);
    }
    // Rests until the place has ended. A rest is over at once while nobody leads; how the first other one ended.
    Rest rest_beside(const std::function<void()>& place) {
        std::atomic<bool> ended{false};
        std::jthread its([&] {
            place();
            ended = true;
        });
        Rest first = Rest::lapsed;
        while (!ended)
            if (const auto how = rest(); first == Rest::lapsed) first = how;
        return first;
    }

    Door door;
    Leadership leadership{door};
    Wakeup never, others;
};

TEST_F(LeadershipTest, IsTheHostsWhileNoPlaceIdles) {
    EXPECT_EQ(rest(), Rest::lapsed);
    EXPECT_FALSE(leadership.wanted(std::chrono::steady_clock::now()));
}

TEST_F(LeadershipTest, IsWantedByAPlaceThatIdlesWhileTheHostLeads) {
    std::jthread([&] { wait_once(1ms); }).join();
    EXPECT_TRUE(leadership.wanted(std::chrono::steady_clock::now()));
    EXPECT_EQ(door.taken, 0);
}

TEST_F(LeadershipTest, OfAPlaceTakesInWhatComesAndSendsWhatIsAnswered) {
    for (int i = 0; i < 3; ++i) door.push("ask");
    rest_beside([&] {
        while (door.taken < 3) wait_once(1ms);
    });
    EXPECT_EQ(door.taken, 3);
    EXPECT_EQ(door.sent, 3);
}

TEST_F(LeadershipTest, CallsTheHostForWhatIsItsOwn) {
    door.push("host");
    const auto how = rest_beside([&] {
        while (!door.left) wait_once(1ms);
    });
    ASSERT_TRUE(door.left);
    EXPECT_EQ(how, Rest::called);
}

TEST_F(LeadershipTest, IsGivenBackByAPlaceThatSleepsWhenTheHostIsCalled) {
    std::atomic<bool> end{false};
    std::jthread place([&] {
        while (!end) wait_once(50ms);
    });
    while (rest(200ms) != Rest::over) {
    }
    others.notify();  // a place leads, and sleeps
    const auto begun = std::chrono::steady_clock::now();
    while (rest() == Rest::lapsed) {
    }
    EXPECT_LT(std::chrono::steady_clock::now() - begun, long_rest);
    end = true;
}

TEST_F(LeadershipTest, LapsesWhenAPlaceThatHasLedComputes) {
    std::atomic<bool> computes{false}, end{false};
    std::jthread place([&] {
        while (door.taken == 0) wait_once(50ms);
        computes = true;
        while (!end) std::this_thread::sleep_for(1ms);
    });
    while (rest(200ms) != Rest::over) {
    }
    door.push("ask");  // the host sleeps deeply by now, and must be told
    Rest how = Rest::over;
    while (!computes || how != Rest::lapsed) how = rest();
    EXPECT_EQ(door.sent, 1);
    end = true;
}

TEST_F(LeadershipTest, IsGivenBackByAPlaceThatFails) {
    door.push("fault");
    std::atomic<bool> failed{false};
    rest_beside([&] {
        while (!failed) try {
                wait_once(1ms);
            } catch (const std::runtime_error&) {
                failed = true;
            }
    });
    EXPECT_TRUE(failed);
    EXPECT_EQ(rest(), Rest::lapsed) << "nobody holds it";
}

TEST_F(LeadershipTest, OfManyLosesNothingAndIsOnesAtATime) {
    constexpr int words = 20'000;
    std::atomic<int> said{0};
    std::atomic<bool> end{false};
    std::vector<std::jthread> places;
    for (int i = 0; i < 3; ++i)
        places.emplace_back([&, i] {
            while (!end) {
                wait_once(std::chrono::milliseconds(1 + i));
                auto frames = word("answer");  // of a place that computes while another leads
                if (said.fetch_add(1) >= words) continue;
                door.replies.push_always(frames);
                leadership.send(door.replies);
            }
        });
    std::jthread asker([&] {
        for (int i = 0; i < words; ++i) {
            door.push(i % 1000 == 999 ? "host" : "ask");
            if (i % 64 == 0) std::this_thread::yield();
        }
    });
    int own = 0;
    const auto begun = std::chrono::steady_clock::now();
    while ((door.taken + own < words || door.sent < door.taken + std::min(said.load(), words)) &&
           std::chrono::steady_clock::now() - begun < long_rest) {
        rest(5ms);
        while (!door.take_in()) door.left.reset(), ++own;
        door.send();
    }
    end = true;
    EXPECT_EQ(door.taken + own, words);
    EXPECT_EQ(own, words / 1000);
    EXPECT_EQ(door.sent, door.taken + std::min(said.load(), words));
    EXPECT_EQ(door.together, 0);
}

}  // namespace
}  // namespace lightnet::leadership_test
