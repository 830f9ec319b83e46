// What places are at, as it is seen and as it travels.
#include "core/run/message/figures.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "core/run/assembly/sampling_profiler.hpp"
#include "tests/support/slowdown.hpp"

namespace lightnet::figures_test {
namespace {

TEST(HostFigures, ComeBackFromTheirText) {
    const HostFigures figures{{{1, 2, 3, 4}, {5, 6, 7, 8}}, {{9, 10, 11, 12, 13, 14, 15}}, {{16, 1, 2, 3}, {17}, {18}}};
    EXPECT_EQ(figures_from(to_text(figures)), figures);
    EXPECT_EQ(figures_from(to_text(HostFigures{})), HostFigures{});
}

TEST(HostFigures, AreNotReadFromWhatIsDamaged) {
    const auto text = to_text(HostFigures{{{1, 2, 3, 4}}, {{9, 10, 11, 12, 13, 14, 15}}, {{16, 17, 18, 19}}});
    for (std::size_t size = 0; size < text.size(); ++size) EXPECT_FALSE(figures_from(text.substr(0, size))) << size;
    for (const auto* damaged : {"", "x", "1 ", "99999999999999999999 ", "4294967295 ", "0 0 0 0 ", "0 0 -1 "})
        EXPECT_FALSE(figures_from(damaged)) << damaged;
}

TEST(SamplingProfiler, SeesWhatPlacesAreAt) {
    Gauge working(3, 2), waiting(3, 2);
    working.set_activity(Gauge::at(2));
    waiting.set_activity(Gauge::waiting);
    working.edges[1].questions.add(5);
    waiting.edges[1].questions.add(6);
    waiting.nodes[0].bundles.add(7);
    const SamplingProfiler profiler({&working, &waiting});
    HostFigures seen;
    for (const auto end = std::chrono::steady_clock::now() + test::slowdown * std::chrono::seconds(30);
         std::chrono::steady_clock::now() < end && seen.places.empty();) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        if (const auto now = profiler.figures(); now.places[0].busy > 1) seen = now;
    }
    ASSERT_EQ(seen.places.size(), 2u);
    EXPECT_EQ(seen.places[1].waiting, seen.places[0].busy);
    EXPECT_EQ(seen.nodes[2].looks, seen.places[0].busy);
    EXPECT_EQ(seen.nodes[0].bundles, 7u);
    EXPECT_EQ(seen.edges[1].questions, 11u);
}

TEST(Gauge, SaysAgainWhatCameBefore) {
    Gauge gauge(2, 0);
    gauge.set_activity(Gauge::at(0));
    {
        const ScopedActivity turned(gauge, Gauge::at(1));
        EXPECT_EQ(gauge.doing(), Gauge::at(1));
    }
    EXPECT_EQ(gauge.doing(), Gauge::at(0));
}

}  // namespace
}  // namespace lightnet::figures_test
