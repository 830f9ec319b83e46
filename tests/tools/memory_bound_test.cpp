// Which daemon of several is to end when all of them hold too much.
#include "tools/daemon/memory_bound.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <vector>

namespace lightnet {
namespace {

using namespace std::chrono_literals;
using Uses = std::vector<std::optional<ProcessUse>>;

// Of processes that were looked at once a second; each time each has computed for so long.
std::optional<MemoryBound::Verdict> verdict(std::uint64_t most, const std::vector<Uses>& seconds) {
    MemoryBound bound(most);
    MemoryBound::Time now{};
    std::optional<MemoryBound::Verdict> last;
    for (const auto& all : seconds) last = bound.look(all, now += 1s);
    return last;
}

TEST(MemoryBound, HasNobodyEndWhereAllFit) {
    EXPECT_FALSE(verdict(100, {{ProcessUse{40, 0ms}, ProcessUse{60, 0ms}}}));
    EXPECT_TRUE(verdict(99, {{ProcessUse{40, 0ms}, ProcessUse{60, 0ms}}}));
}

TEST(MemoryBound, HasEndWhoeverHasComputedNothingForLongest) {
    const auto found = verdict(100, {{ProcessUse{60, 0ms}, ProcessUse{70, 0ms}, ProcessUse{80, 0ms}},
                                     {ProcessUse{60, 900ms}, ProcessUse{70, 500ms}, ProcessUse{80, 900ms}},
                                     {ProcessUse{60, 910ms}, ProcessUse{70, 501ms}, ProcessUse{80, 1800ms}},
                                     {ProcessUse{60, 1800ms}, ProcessUse{70, 502ms}, ProcessUse{80, 1810ms}}});
    ASSERT_TRUE(found);
    EXPECT_EQ(found->number, 1u);
    EXPECT_EQ(found->idle, 2s);
    EXPECT_EQ(found->together, 210u);
    EXPECT_EQ(found->its, 70u);
}

TEST(MemoryBound, HasTheLargestEndOfThoseAtWork) {
    const auto found = verdict(100, {{ProcessUse{70, 0ms}, ProcessUse{80, 0ms}, ProcessUse{75, 0ms}},
                                     {ProcessUse{70, 900ms}, ProcessUse{80, 900ms}, ProcessUse{75, 900ms}}});
    ASSERT_TRUE(found);
    EXPECT_EQ(found->number, 1u);
}

TEST(MemoryBound, LeavesThoseAloneThatHoldNoMoreThanAnEqualPart) {
    const auto found =
        verdict(100, {{ProcessUse{10, 0ms}, ProcessUse{95, 0ms}}, {ProcessUse{10, 0ms}, ProcessUse{95, 900ms}}});
    ASSERT_TRUE(found);
    EXPECT_EQ(found->number, 1u) << "though the other one is idle";
}

TEST(MemoryBound, CountsAnewWhoWasStartedAnew) {
    const auto found = verdict(100, {{ProcessUse{60, 9000ms}, ProcessUse{60, 0ms}},
                                     {std::nullopt, ProcessUse{60, 0ms}},
                                     {ProcessUse{60, 10ms}, ProcessUse{60, 0ms}}});
    ASSERT_TRUE(found);
    EXPECT_EQ(found->number, 1u);
    EXPECT_EQ(found->idle, 2s);
}

TEST(MemoryBound, SeesWhatAProcessHolds) {
    const auto before = use_of(getpid()).value();
    const std::vector<char> more(64 << 20, 'x');
    const auto after = use_of(getpid()).value();
    EXPECT_NEAR(static_cast<double>(after.memory - before.memory), static_cast<double>(more.size()), 8 << 20);
    EXPECT_GE(after.computed, before.computed);
    EXPECT_FALSE(use_of(0));
}

}  // namespace
}  // namespace lightnet
