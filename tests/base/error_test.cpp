#include "core/base/error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lightnet::error_test {
namespace {

TEST(Problem, SaysFileAndLine) { EXPECT_EQ(to_string({{"a.lua", 7}, "no such node"}), "a.lua:7: no such node"); }

TEST(Problem, LeavesOutALineThatIsNotKnown) {
    EXPECT_EQ(to_string({{"a.lua", 0}, "no such file"}), "a.lua: no such file");
}

TEST(Problem, StandsAloneWithoutAFile) { EXPECT_EQ(to_string({{}, "no such flag"}), "no such flag"); }

TEST(UserError, TellsAllProblemsALineEach) {
    const UserError error({{{"a.lua", 1}, "first"}, {{"b.lua", 2}, "second"}});
    EXPECT_STREQ(error.what(), "a.lua:1: first\nb.lua:2: second");
    EXPECT_THAT(error.problems(), testing::SizeIs(2));
}

TEST(Error, NamesThePlaceFirst) {
    EXPECT_STREQ(Error("bounce on onyx2", "out of memory").what(), "bounce on onyx2: out of memory");
}

}  // namespace
}  // namespace lightnet::error_test
