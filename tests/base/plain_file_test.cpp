// Files that would make us wait or read for ever are refused when they are opened; what an OpenEXR claims is looked at.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstring>

#include "core/base/error.hpp"
#include "core/base/exr_claims.hpp"
#include "core/base/plain_file.hpp"
#include "tests/support/folder.hpp"

namespace lightnet::plain_file_test {
namespace {

using testing::HasSubstr;

std::string error_of(const std::string& path, std::uint64_t most = 1000) {
    try {
        PlainFile(path, most).text();
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(PlainFile, IsReadWhole) {
    const test::Folder folder;
    EXPECT_EQ(PlainFile(folder.write("a", "some text"), 100).text(), "some text");
    EXPECT_EQ(PlainFile(folder.write("b", ""), 100).bytes().size(), 0u);
}

TEST(PlainFile, IsNoPipeDeviceOrFolderAndNotTooLarge) {
    const test::Folder folder;
    const std::string pipe = folder / "pipe";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_THAT(error_of(pipe), HasSubstr("pipe: is no file, but a pipe or a device"));
    EXPECT_THAT(error_of("/dev/zero"), HasSubstr("is no file, but a pipe or a device"));
    EXPECT_THAT(error_of(folder.path()), HasSubstr("is a folder"));
    EXPECT_THAT(error_of(folder / "none"), HasSubstr("none: no such file"));
    EXPECT_THAT(error_of(folder.write("large", std::string(1001, 'x'))), HasSubstr("are taken"));
}

std::string attribute(const std::string& name, const std::string& type, const std::string& value,
                      std::uint32_t length) {
    std::string text = name + '\0' + type + '\0';
    text.append(reinterpret_cast<const char*>(&length), sizeof length);
    return text + value;
}

std::string window(std::int32_t width, std::int32_t height) {
    const std::int32_t sides[4]{0, 0, width - 1, height - 1};
    return attribute("dataWindow", "box2i", {reinterpret_cast<const char*>(sides), sizeof sides}, sizeof sides);
}

void check(const std::string& attributes, std::size_t rest) {
    const std::string file = std::string("\x76\x2f\x31\x01\x02\0\0\0", 8) + attributes + '\0' + std::string(rest, 'x');
    check_exr_claims(std::as_bytes(std::span(file)));
}

TEST(ExrClaims, AreBelievedWhereTheFileCanHaveThem) {
    EXPECT_NO_THROW(check(window(1024, 1024) + attribute("compression", "compression", "\3", 1), 3000));
    EXPECT_NO_THROW(check(attribute("owner", "string", "me", 2) + window(1, 1), 100));
    EXPECT_NO_THROW(check("", 0));
}

TEST(ExrClaims, ArePixelsThatNoCompressionPacksIntoSoFewBytes) {
    EXPECT_THROW(check(window(8192, 8192) + attribute("compression", "compression", "\3", 1), 3000), Error);
    EXPECT_THROW(check(window(2147483647, 2147483647), 3000), Error);
}

TEST(ExrClaims, AreThoseOfAllPartsTogether) {
    const auto parts = [](int count) {
        std::string file("\x76\x2f\x31\x01\x02\x10\0\0", 8);
        for (int part = 0; part < count; ++part)
            file += window(1024, 1024) + attribute("compression", "compression", "\3", 1) + '\0';
        file += '\0' + std::string(3000, 'x');
        check_exr_claims(std::as_bytes(std::span(file)));
    };
    EXPECT_NO_THROW(parts(2));
    EXPECT_THROW(parts(200), Error);
}

TEST(ExrClaims, AreAttributesLongerThanTheFile) {
    EXPECT_THROW(check(attribute("odd", "opaque", "x", 1'700'000'000), 200), Error);
    EXPECT_THROW(check(attribute("odd", "string", "x", 0xffffffff), 200), Error);
}

std::string number(std::uint32_t value) { return {reinterpret_cast<const char*>(&value), sizeof value}; }

// One of floats, of that name.
std::string channel(const std::string& name) { return name + '\0' + number(2) + number(0) + number(1) + number(1); }

// Libraries read a list to its own end, so that what an attribute says of its size must be that: else what follows
// would be taken for the size of something else, and for so much memory.
TEST(ExrClaims, AreSizesOfAttributesThatAreRightForTheirType) {
    const std::string list = channel("R") + channel("G") + '\0';
    const auto size = [](const std::string& value) { return static_cast<std::uint32_t>(value.size()); };
    EXPECT_NO_THROW(check(attribute("channels", "chlist", list, size(list)) + window(8, 8), 300));
    EXPECT_THROW(check(attribute("channels", "chlist", list, size(channel("R"))) + window(8, 8), 300), Error);
    EXPECT_THROW(check(attribute("channels", "chlist", list + "xyz", size(list) + 3) + window(8, 8), 300), Error);
    EXPECT_THROW(check(attribute("screen", "box2i", std::string(8, '\0'), 8), 300), Error);
    EXPECT_THROW(check(attribute("ratio", "float", std::string(8, '\0'), 8), 300), Error);

    const std::string names = number(2) + "ab" + number(1) + "c";
    EXPECT_NO_THROW(check(attribute("names", "stringvector", names, size(names)), 300));
    const std::string longer = number(2) + "ab" + number(1'700'000'000) + "c";
    EXPECT_THROW(check(attribute("names", "stringvector", longer, size(longer)), 300), Error);

    const std::string preview = number(2) + number(1) + std::string(8, 'p');
    EXPECT_NO_THROW(check(attribute("preview", "preview", preview, size(preview)), 300));
    const std::string large = number(65536) + number(65536) + std::string(8, 'p');
    EXPECT_THROW(check(attribute("preview", "preview", large, size(large)), 300), Error);
}

}  // namespace
}  // namespace lightnet::plain_file_test
