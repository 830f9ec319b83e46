#include "core/hash.hpp"

#include <gtest/gtest.h>

#include <unordered_set>

namespace lightnet {
namespace {

TEST(Hash, IsBlake2bOf32Bytes) {
    // the digest of "abc", as by `b2sum -l 256`
    EXPECT_EQ(to_hex(content_hash("abc")), "bddd813c634239723171ef3fee98579b94964e3bb1cb3e427262c8c068d52319");
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

}  // namespace
}  // namespace lightnet
