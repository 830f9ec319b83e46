#include "core/base/name_id.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <string>

namespace lightnet::name_id_test {
namespace {

// Of the reference implementation, SMHasher's MurmurHash3_x86_32.
TEST(NameId, IsMadeOfMurmurHash3) {
    EXPECT_EQ(murmur3(""), 0u);
    EXPECT_EQ(murmur3("", 1), 0x514e28b7u);
    EXPECT_EQ(murmur3("test"), 0xba6bd213u);
    EXPECT_EQ(murmur3("Hello, world!"), 0xc0363e43u);
    EXPECT_EQ(murmur3("aaa", 0x9747b28cu), 0x283e0130u) << "three bytes behind the last whole word";
    EXPECT_EQ(murmur3("aa", 0x9747b28cu), 0x5d211726u);
    EXPECT_EQ(murmur3("a", 0x9747b28cu), 0x7fa09ea6u);
    EXPECT_EQ(murmur3("The quick brown fox jumps over the lazy dog", 0x9747b28cu), 0x2fa826cdu);
}

// Of the tests of Cryptomatte's reference implementation.
TEST(NameId, IsThatOfCryptomatte) {
    EXPECT_FLOAT_EQ(name_id("hello"), 6.0705627102400005616e-17f);
    EXPECT_FLOAT_EQ(name_id("cube"), -4.08461912519e+15f);
    EXPECT_FLOAT_EQ(name_id("sphere"), 2.79018604383e+15f);
    EXPECT_FLOAT_EQ(name_id("plane"), 3.66557617593e-11f);
}

// One name in 128 has bits that would be no ordinary number.
TEST(NameId, IsAlwaysAnOrdinaryNumber) {
    int turned = 0;
    for (int i = 0; i < 10000; ++i) {
        const auto name = "thing " + std::to_string(i);
        EXPECT_TRUE(std::isnormal(name_id(name))) << name;
        turned += std::bit_cast<std::uint32_t>(name_id(name)) != murmur3(name);
    }
    EXPECT_GT(turned, 0);
    EXPECT_LT(turned, 1000);
}

}  // namespace
}  // namespace lightnet::name_id_test
