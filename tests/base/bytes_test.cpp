#include "core/base/bytes.hpp"

#include <gtest/gtest.h>

#include <cstdint>

namespace lightnet::bytes_test {
namespace {

TEST(Bytes, GiveBackTheValuesTheyWereMadeOf) {
    const std::vector<std::uint32_t> values{1, 2, 3000000000};
    const auto bytes = bytes_of(values);
    EXPECT_EQ(bytes->size(), 12u);
    EXPECT_EQ(values_of<std::uint32_t>(bytes), values);
}

TEST(Bytes, HoldNoValuesWhenThereAreNone) {
    EXPECT_TRUE(values_of<std::uint32_t>(nullptr).empty());
    EXPECT_TRUE(values_of<std::uint32_t>(bytes_of(std::vector<std::uint32_t>{})).empty());
}

TEST(Bytes, DropWhatIsLeftOverBehindTheLastWholeValue) {
    const std::vector<std::uint8_t> five(5, 1);
    EXPECT_EQ(values_of<std::uint32_t>(bytes_of(five)), std::vector<std::uint32_t>{0x01010101});
}

}  // namespace
}  // namespace lightnet::bytes_test
