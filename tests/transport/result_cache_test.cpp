#include "transport/result_cache.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/support/folder.hpp"

namespace lightnet::result_cache_test {
namespace {

namespace fs = std::filesystem;

Result result_of(const std::string& text) {
    const auto* data = reinterpret_cast<const std::byte*>(text.data());
    auto bytes = std::make_shared<const std::vector<std::byte>>(data, data + text.size());
    const Hash name = content_hash(*bytes);
    return {name, std::move(bytes)};
}

Hash recipe(const std::string& name) { return content_hash("recipe of " + name); }

class ResultCacheTest : public ::testing::Test {
protected:
    void keep(const std::vector<std::string>& names, std::uint64_t most_bytes = usual_cache_size) {
        DiskResultCache cache(folder, most_bytes);
        for (const auto& name : names) cache.keep(recipe(name), result_of(name));
    }
    std::string found(const std::string& name) {
        const auto result = DiskResultCache(folder).find(recipe(name));
        if (!result.bytes) return "";
        return {reinterpret_cast<const char*>(result.bytes->data()), result.bytes->size()};
    }
    fs::path file_of(const std::string& name) { return fs::path(folder) / "recipes" / to_hex(recipe(name)); }
    static std::string text_of(const fs::path& path) {
        std::ostringstream text;
        text << std::ifstream(path).rdbuf();
        return text.str();
    }
    test::Folder home;
    std::string folder = home / "cache";
};

TEST_F(ResultCacheTest, FindsWhatItWasGivenInAnEarlierRun) {
    keep({"photons", "records"});
    EXPECT_EQ(found("photons"), "photons");
    EXPECT_EQ(found("records"), "records");
    EXPECT_EQ(found("anything"), "");
}

TEST_F(ResultCacheTest, BelievesNoRecipeThatWasSwappedOrChanged) {
    keep({"photons", "records"});
    const auto right = text_of(file_of("photons"));
    const auto try_with = [&](const std::string& text) {
        std::ofstream(file_of("photons")) << text;
        EXPECT_EQ(found("photons"), "") << text;
        keep({"photons"});
    };
    try_with(text_of(file_of("records")));
    try_with(to_hex(result_of("records").name) + "\n");
    auto other_blob = right;
    other_blob.replace(right.find("blob ") + 5, 64, to_hex(result_of("records").name));
    try_with(other_blob);
    try_with(right + "and more");
    try_with("");
    EXPECT_EQ(found("photons"), "photons") << "made anew";
}

TEST_F(ResultCacheTest, IsWithinItsLimitAfterARun) {
    keep({std::string(5000, 'a'), std::string(5000, 'b')}, 8000);
    std::uint64_t sum = 0;
    for (const auto& file : files_of_ours(folder)) sum += file.size;
    EXPECT_LE(sum, 8000u);
}

TEST_F(ResultCacheTest, RemovesRecipesOfBlobsThatAreGone) {
    keep({"photons", "records"});
    fs::remove(fs::path(folder) / to_hex(result_of("photons").name));
    std::ofstream(fs::path(folder) / "recipes" / "notes") << "mine";
    BlobCache(folder).trim();
    EXPECT_FALSE(fs::exists(file_of("photons")));
    EXPECT_TRUE(fs::exists(file_of("records")));
    EXPECT_TRUE(fs::exists(fs::path(folder) / "recipes" / "notes"));
    EXPECT_EQ(found("records"), "records");
}

TEST_F(ResultCacheTest, RemovesRecipesThatWereNotReadForTheLongestTime) {
    keep({"photons", "records"});
    fs::last_write_time(file_of("photons"), fs::file_time_type::clock::now() - std::chrono::hours(2));
    std::uint64_t sum = 0;
    for (const auto& in : {fs::path(folder), fs::path(folder) / "recipes"})
        for (const auto& file : files_of_ours(in)) sum += file.size;
    BlobCache(folder, sum - 1).trim();
    EXPECT_FALSE(fs::exists(file_of("photons")));
    EXPECT_EQ(found("records"), "records");
}

}  // namespace
}  // namespace lightnet::result_cache_test
