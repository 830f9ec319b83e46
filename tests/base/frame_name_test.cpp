// Names of files with a place for the number of a frame.
#include "core/base/frame_name.hpp"

#include <gtest/gtest.h>

namespace lightnet::frame_name_test {
namespace {

TEST(FrameName, HasItsNumberWhereSignsOfNumbersStand) {
    EXPECT_EQ(with_frame("shot.####.exr", 17), "shot.0017.exr");
    EXPECT_EQ(with_frame("shot.##.exr", 1234), "shot.1234.exr") << "no digit is lost";
    EXPECT_EQ(with_frame("shot.%04d.exr", 17), "shot.0017.exr");
    EXPECT_EQ(with_frame("shot.%d.exr", 17), "shot.17.exr");
    EXPECT_EQ(with_frame("take##/shot.####.exr", 3), "take##/shot.0003.exr") << "the last one";
}

TEST(FrameName, LeavesOtherNamesAsTheyAre) {
    for (const char* name : {"shot.exr", "C#.exr", "100%.exr", "50%done.exr", "%0.exr", ""}) {
        EXPECT_EQ(with_frame(name, 17), name);
        EXPECT_FALSE(has_frame_place(name)) << name;
    }
}

TEST(FrameName, IsMadeOfANumberAndWithoutOne) {
    EXPECT_EQ(without_frame_place("out/shot.####.exr"), "out/shot.exr");
    EXPECT_EQ(without_frame_place("out/####.exr"), "out/.exr");
    EXPECT_EQ(frame_place_for("shot.0017.exr"), "shot.####.exr");
    EXPECT_EQ(frame_place_for("shot7.exr"), "shot##.exr");
    EXPECT_EQ(frame_place_for("shot.exr"), "");
}

}  // namespace
}  // namespace lightnet::frame_name_test
