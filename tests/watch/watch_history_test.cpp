// What a report remembers of a run that takes long.
#include "tools/watch/watch_history.hpp"

#include <gtest/gtest.h>

#include <string>

namespace lightnet::watch_history_test {
namespace {

using namespace std::chrono_literals;
using Clock = Pace::Clock;

// Of a run of so many seconds, whose states are their seconds.
std::vector<std::string> remembered(std::chrono::seconds length, std::size_t bytes) {
    const Clock::time_point begun{};
    WatchHistory history(begun);
    for (auto time = 0s; time < length; time += 1s) {
        if (!history.due(begun + time)) continue;
        auto text = std::to_string(time.count());
        history.add(text + std::string(bytes - text.size(), ' '), begun + time);
    }
    return history.states();
}

void expect_from_beginning_to_end(const std::vector<std::string>& states, std::chrono::seconds length) {
    ASSERT_GE(states.size(), 8u);
    long last = -1;
    long widest = 0;
    for (const auto& state : states) {
        ASSERT_FALSE(state.empty());
        const long time = std::stol(state);
        EXPECT_GT(time, last);
        widest = std::max(widest, time - last);
        last = time;
    }
    EXPECT_EQ(std::stol(states.front()), 1);
    EXPECT_LE(length.count() - last, widest);
    EXPECT_LT(widest, length.count() / 4);
}

TEST(WatchHistory, KeepsAllOfAShortRun) { EXPECT_EQ(remembered(100s, 10).size(), 99u); }

TEST(WatchHistory, StaysWholeHoweverOftenItIsHalved) {
    for (const auto length : {240s, 310s, 800s, 3600s, 86400s})
        for (const std::size_t bytes : {10u, 20000u}) {
            const auto states = remembered(length, bytes);
            EXPECT_LE(states.size(), 240u);
            expect_from_beginning_to_end(states, length);
        }
}

}  // namespace
}  // namespace lightnet::watch_history_test
