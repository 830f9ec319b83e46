#include "transport/store/results.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <thread>

#include "tests/support/folder.hpp"

namespace lightnet::results_test {
namespace {

class ResultsTest : public ::testing::Test {
protected:
    // On disk and in memory, as it comes over the wire.
    Hash take(int value, std::size_t size) {
        const std::vector<std::byte> bytes(size, static_cast<std::byte>(value));
        const Hash name = content_hash(bytes);
        cache.store(name, bytes);
        results.take(name, std::make_shared<const std::vector<std::byte>>(bytes));
        return name;
    }
    test::Folder home;
    BlobCache cache{home.path()};
    Results results{cache, 100};
};

TEST_F(ResultsTest, KeepsTheLatestInMemoryAndFindsTheOthersOnDisk) {
    const Hash one = take(1, 60), two = take(2, 30), three = take(3, 50);
    EXPECT_FALSE(results.in_memory(one));
    EXPECT_TRUE(results.in_memory(two) && results.in_memory(three));
    const auto found = results.find(one);
    ASSERT_TRUE(found);
    EXPECT_EQ(*found, std::vector<std::byte>(60, std::byte{1}));
}

TEST_F(ResultsTest, KeepsAtLeastOneHoweverLarge) { EXPECT_TRUE(results.in_memory(take(1, 1000))); }

TEST_F(ResultsTest, FindsInMemoryWhatSomebodyStillLooksAt) {
    const Hash one = take(1, 60);
    const auto held = results.find(one);
    take(2, 90);
    EXPECT_EQ(results.find(one), held);
}

TEST_F(ResultsTest, PutsOnDiskWhatIsToBeKept) {
    const auto bytes = std::make_shared<const std::vector<std::byte>>(60, std::byte{1});
    const Hash name = content_hash(*bytes);
    results.keep(name, bytes);
    EXPECT_TRUE(results.in_memory(name));
    take(2, 90);
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!cache.has(name) && std::chrono::steady_clock::now() < end) std::this_thread::yield();
    EXPECT_EQ(*results.find(name), *bytes);
}

TEST_F(ResultsTest, HoldsWhatTheDiskRefuses) {
    const auto bytes = std::make_shared<const std::vector<std::byte>>(60, std::byte{1});
    const Hash name = content_hash(*bytes);
    std::filesystem::remove_all(home.path());
    for (int i = 0; i < 2; ++i) results.keep(name, bytes);
    results.take(content_hash(std::string_view("another")), std::make_shared<const std::vector<std::byte>>(200));
    EXPECT_TRUE(results.find(name));
}

TEST_F(ResultsTest, HasNothingThatItWasNotGiven) {
    EXPECT_EQ(results.find(content_hash(std::string_view("anything"))), nullptr);
}

}  // namespace
}  // namespace lightnet::results_test
