#include "core/base/hash.hpp"

#include <gtest/gtest.h>

#include <unordered_set>

namespace lightnet::hash_test {
namespace {

TEST(Hash, IsSha256) {
    // the digest of "abc", as by `sha256sum`
    EXPECT_EQ(to_hex(content_hash("abc")), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Hash, TellsContentsApart) {
    EXPECT_NE(content_hash("a"), content_hash("b"));
    EXPECT_EQ(content_hash(""), content_hash(std::span<const std::byte>{}));
    EXPECT_NE(content_hash(""), Hash{});
}

TEST(Hash, ComesBackFromItsHexDigits) {
    const Hash hash = content_hash("lightnet");
    EXPECT_EQ(hash_from_hex(to_hex(hash)), hash);
}

TEST(Hash, RefusesWhatIsNoHash) {
    const std::string hex = to_hex(content_hash("x"));
    EXPECT_FALSE(hash_from_hex(hex.substr(1)));
    EXPECT_FALSE(hash_from_hex(hex + "0"));
    EXPECT_FALSE(hash_from_hex("g" + hex.substr(1)));
    EXPECT_FALSE(hash_from_hex(""));
}

TEST(Hash, IsAKeyOfMaps) {
    const std::unordered_set<Hash> set{content_hash("a"), content_hash("b"), content_hash("a")};
    EXPECT_EQ(set.size(), 2u);
    EXPECT_TRUE(content_hash("a") < content_hash("b") || content_hash("b") < content_hash("a"));
}

// RFC 4231, test case 2.
TEST(KeyedHash, IsThatOfTheStandard) {
    EXPECT_EQ(to_hex(keyed_hash("Jefe", "what do ya want for nothing?")),
              "5bdcc146bf60754e6a042426089575c75a003f089d2739839dec58b964ec3843");
}

}  // namespace
}  // namespace lightnet::hash_test
