#include "core/base/printable.hpp"

#include <gtest/gtest.h>

#include "core/base/error.hpp"

namespace lightnet::printable_test {
namespace {

TEST(Printable, LeavesWordsOfAnyLanguageAlone) {
    EXPECT_EQ(printable("box × 2 … Größe 光"), "box × 2 … Größe 光");
    EXPECT_EQ(printable(""), "");
}

TEST(Printable, WritesOutWhatCommandsATerminal) {
    EXPECT_EQ(printable("\x1b]0;title\x07"), "\\x1b]0;title\\x07");
    EXPECT_EQ(printable("\xc2\x9b"
                        "2J"),
              "\\xc2\\x9b2J")
        << "in UTF-8, too";
    EXPECT_EQ(printable("a\x7f\r"), "a\\x7f\\x0d");
    EXPECT_EQ(printable("a\n\tb"), "a\\x0a\\x09b");
    EXPECT_EQ(printable("a\n\tb", true), "a\n\tb");
}

TEST(Printable, WritesOutWhatIsNoText) {
    EXPECT_EQ(printable("\xff\xc3"), "\\xff\\xc3");
    EXPECT_EQ(printable("\xe5\x85"), "\\xe5\\x85") << "it ends early";
    EXPECT_EQ(printable(std::string_view("a\0b", 3)), "a\\x00b");
}

TEST(Printable, LeavesUtf8AsItIs) {
    EXPECT_TRUE(is_utf8("gr\xc3\xbcn \xe2\x82\xac \xf0\x9f\x92\xa1"));
    for (const char* text : {"\xff", "sc\xe4ne", "\xc0\x80", "\xe0\x80\x80", "\xed\xa0\x80", "\xf0\x80\x80\x80",
                             "\xf4\x90\x80\x80", "\xf5\x80\x80\x80", "\xe2\x82"})
        EXPECT_FALSE(is_utf8(text)) << printable(text);
    EXPECT_EQ(in_utf8("gr\xc3\xbcn\t"), "gr\xc3\xbcn\t");
    EXPECT_EQ(in_utf8("sc\xe4ne"), "sc\\xe4ne");
}

TEST(Printable, IsWhatErrorsSayOfFiles) {
    EXPECT_STREQ(Error("a\x1b[2J.exr", "is no picture").what(), "a\\x1b[2J.exr: is no picture");
    EXPECT_STREQ(UserError({"a\nb.lua", 3}, "no node '\x1b[31m'\nand more").what(),
                 "a\\x0ab.lua:3: no node '\\x1b[31m'\nand more");
}

}  // namespace
}  // namespace lightnet::printable_test
