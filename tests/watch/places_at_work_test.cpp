// How many places were at work, whoever came and went.
#include "tools/watch/places_at_work.hpp"

#include <gtest/gtest.h>

namespace lightnet::places_at_work_test {
namespace {

// Of one place, looked at a hundred times a second.
HostState host(const std::string& name, std::uint64_t busy, std::uint64_t idle, bool there = true) {
    HostState state;
    state.name = name, state.there = there;
    state.figures.places = {{busy, 0, 0, idle}};
    return state;
}

TEST(PlacesAtWork, AreThoseThatWereThere) {
    PlacesAtWork work;
    work.look({host("a", 0, 0), host("b", 0, 0)}, 0);
    work.look({host("a", 100, 0), host("b", 100, 0)}, 1);
    EXPECT_DOUBLE_EQ(work.average(), 2);
    work.look({host("a", 200, 0), host("b", 100, 0, false)}, 2);
    work.look({host("a", 300, 0), host("b", 100, 0, false)}, 3);
    work.look({host("a", 400, 0), host("b", 100, 0, false)}, 4);
    EXPECT_DOUBLE_EQ(work.average(), 1.25) << "b was busy for one second of four, and has left";
}

TEST(PlacesAtWork, CountFromWhenTheyCome) {
    PlacesAtWork work;
    work.look({host("a", 0, 0)}, 0);
    work.look({host("a", 50, 50), host("late", 0, 0)}, 1);
    work.look({host("a", 100, 100), host("late", 100, 0)}, 2);
    EXPECT_DOUBLE_EQ(work.average(), 1);
}

TEST(PlacesAtWork, AreTakenForWhatTheySaidLastUntilTheySayMore) {
    PlacesAtWork work;
    work.look({host("a", 0, 0)}, 0);
    work.look({host("a", 100, 0)}, 1);
    work.look({host("a", 100, 0)}, 2);
    EXPECT_DOUBLE_EQ(work.average(), 1);
    work.look({host("a", 0, 50)}, 3);
    EXPECT_DOUBLE_EQ(work.average(), 2.0 / 3) << "its host was started anew, and has counted from nothing";
}

}  // namespace
}  // namespace lightnet::places_at_work_test
