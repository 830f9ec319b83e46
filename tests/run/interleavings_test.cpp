// Everything that can happen between two askers and three hosts, in every order, with up to two faults.
#include "tests/run/interleavings.hpp"

#include <gtest/gtest.h>

#include <array>
#include <unordered_set>

namespace lightnet::interleavings_test {
namespace {

using namespace test;

using Path = std::vector<WorldStep>;

struct Explored {
    std::size_t states = 0, ends = 0, asked_again = 0, written_off = 0;
    std::string wrong;
};

std::string words_for(const Path& path) {
    constexpr std::array names{"work",     "deliver",     "notice", "pass", "come",
                               "lose_ask", "lose_answer", "twice",  "die",  "cut"};
    std::string text;
    for (const auto& step : path)
        text +=
            std::string(text.empty() ? "" : ", ") + names[std::size_t(step.kind)] + ' ' + std::to_string(step.which);
    return text;
}

// Depth first; a state that was seen before is not looked at again.
Explored explore(const WorldBounds& bounds) {
    Explored explored;
    std::unordered_set<std::uint64_t> seen;
    std::vector<Path> left{{}};
    while (!left.empty() && explored.wrong.empty()) {
        const Path path = std::move(left.back());
        left.pop_back();
        InterleavedWorld world(bounds);
        for (const auto& step : path) world.take(step);
        if (!world.wrong().empty()) explored.wrong = world.wrong() + ": " + words_for(path);
        if (!seen.insert(world.digest()).second) continue;
        ++explored.states;
        const auto steps = world.steps();
        if (steps.empty()) {
            ++explored.ends;
            explored.asked_again += world.counts().asked_again > 0,
                explored.written_off += world.counts().written_off > 0;
        }
        for (const auto& step : steps) {
            left.push_back(path);
            left.back().push_back(step);
        }
    }
    return explored;
}

void expect_sound(const Explored& explored, std::size_t least_states) {
    EXPECT_EQ(explored.wrong, "");
    EXPECT_GT(explored.ends, 0u);
    EXPECT_GE(explored.states, least_states);
    testing::Test::RecordProperty("states", std::to_string(explored.states));
}

#ifndef LIGHTNET_LARGE

TEST(Interleavings, AreAllSoundWithoutFaults) {
    const auto explored = explore({.bundles = 2, .faults = 0, .passes = 1});
    expect_sound(explored, 100);
    EXPECT_EQ(explored.asked_again, 0u) << "time alone loses nothing";
}

TEST(Interleavings, AreAllSoundWithOneFault) {
    const auto explored = explore({.bundles = 1, .faults = 1, .passes = 1});
    expect_sound(explored, 300);
    EXPECT_GT(explored.asked_again, 0u);
    EXPECT_GT(explored.written_off, 0u);
}

#else

// Time passes where nothing else can happen: what is late is found then.
TEST(InterleavingsLarge, AreAllSoundWithTwoFaults) {
    const auto explored = explore({.bundles = 2, .faults = 2, .passes = 0});
    expect_sound(explored, 100000);
    EXPECT_GT(explored.asked_again, 0u);
    EXPECT_GT(explored.written_off, 0u);
}

TEST(InterleavingsLarge, AreAllSoundWhileTimePasses) {
    expect_sound(explore({.bundles = 1, .faults = 2, .passes = 1}), 100000);
}

#endif

}  // namespace
}  // namespace lightnet::interleavings_test
