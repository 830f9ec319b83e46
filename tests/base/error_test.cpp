#include "core/base/error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <ios>
#include <new>
#include <system_error>

#include "core/base/words_of.hpp"

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

TEST(Error, OfTheLibraryIsToldInWords) {
    EXPECT_EQ(words_of(std::bad_alloc()), "there is not enough memory");
    const auto full = std::make_error_code(std::errc::no_space_on_device);
    EXPECT_EQ(words_of(std::filesystem::filesystem_error("cannot create directory", "/a/b", full)),
              "/a/b: No space left on device");
    EXPECT_EQ(words_of(std::ios_base::failure("basic_filebuf::underflow", full)),
              "a file can't be read or written: No space left on device");
    EXPECT_EQ(words_of(Error("a", "b")), "a: b");
    const std::system_error no_thread(std::make_error_code(std::errc::resource_unavailable_try_again));
    EXPECT_THAT(words_of(no_thread), testing::StartsWith("the system gives no more threads; a higher limit"));
    EXPECT_EQ(words_of(std::system_error(std::make_error_code(std::errc::no_space_on_device), "x")),
              "x: No space left on device");
}

}  // namespace
}  // namespace lightnet::error_test
