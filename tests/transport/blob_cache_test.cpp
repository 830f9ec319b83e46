#include "transport/store/blob_cache.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>

#include "core/base/error.hpp"
#include "tests/support/folder.hpp"
#include "transport/store/cache_claim.hpp"

namespace lightnet::blob_cache_test {
namespace {

namespace fs = std::filesystem;

class BlobCacheTest : public ::testing::Test {
protected:
    static std::vector<std::byte> bytes(const std::string& text) {
        const auto* data = reinterpret_cast<const std::byte*>(text.data());
        return {data, data + text.size()};
    }
    // As it comes over the wire: in pieces.
    static void keep(const BlobCache& cache, const std::vector<std::byte>& blob) {
        auto incoming = cache.receive(content_hash(blob), blob.size());
        for (std::size_t at = 0; at < blob.size(); at += 3)
            incoming.take(at, std::span(blob).subspan(at, std::min<std::size_t>(3, blob.size() - at)));
    }
    static bool holds_nothing(const fs::path& folder) {
        const fs::directory_iterator files(folder);
        return std::all_of(begin(files), end(files),
                           [](const auto& file) { return file.path().filename() == "CACHEDIR.TAG"; });
    }
    test::Folder home;
    fs::path folder = home.path();
};

TEST_F(BlobCacheTest, RefusesWhatIsNotWhatItsNameSaysAndLeavesNothing) {
    const BlobCache cache(folder);
    EXPECT_THROW(cache.receive(content_hash(bytes("a mesh")), 6).take(0, bytes("a mash")), Error);
    EXPECT_THROW(cache.receive(content_hash(bytes("a mesh")), 6).take(0, bytes("a mesh!")), Error) << "too long";
    EXPECT_FALSE(cache.receive(content_hash(bytes("half")), 4).take(0, bytes("ha")));
    EXPECT_TRUE(holds_nothing(folder));
}

TEST_F(BlobCacheTest, MakesRoomForWhatComesAndLeavesWhatIsClaimed) {
    const BlobCache cache(folder, 20);
    const auto mine = bytes("mine......"), others = bytes("others...."), old = bytes("old.......");
    for (const auto& blob : {mine, others, old}) cache.store(content_hash(blob), blob);
    std::optional<CacheClaim> run(std::in_place, folder), another(std::in_place, folder);
    run->add({content_hash(mine)});
    another->add({content_hash(others)});
    cache.make_room(15);
    EXPECT_TRUE(cache.has(content_hash(mine)) && cache.has(content_hash(others)));
    EXPECT_FALSE(cache.has(content_hash(old)));
    another.reset();
    cache.make_room(15);
    EXPECT_TRUE(cache.has(content_hash(mine)));
    EXPECT_FALSE(cache.has(content_hash(others))) << "nobody claims it any more";
}

TEST_F(BlobCacheTest, ForgetsTheClaimsOfTheDead) {
    const BlobCache cache(folder, 5);
    const auto blob = bytes("a mesh");
    cache.store(content_hash(blob), blob);
    std::ofstream(folder / "claim-1-2") << to_hex(content_hash(blob)) << "\n";
    cache.trim();
    EXPECT_FALSE(cache.has(content_hash(blob)));
    EXPECT_FALSE(fs::exists(folder / "claim-1-2"));
}

TEST_F(BlobCacheTest, KeepsBytesByTheirHash) {
    BlobCache cache(folder);
    const auto blob = bytes("a mesh");
    const auto hash = content_hash(blob);
    EXPECT_FALSE(cache.has(hash));
    keep(cache, blob);
    EXPECT_EQ(*BlobCache(folder).read(hash), blob) << "another process finds it";
}

TEST_F(BlobCacheTest, StoresAWholeBlobAtOnce) {
    const BlobCache cache(folder);
    const auto blob = bytes("photons");
    cache.store(content_hash(blob), blob);
    EXPECT_EQ(*cache.read(content_hash(blob)), blob);
    fs::remove_all(folder);
    EXPECT_THROW(cache.store(content_hash(blob), blob), Error) << "the disk refuses";
}

// As when a line is cut in the middle of it.
TEST_F(BlobCacheTest, TakesABlobFromItsBeginningAgainBeforeTheFirstAttemptIsGivenUp) {
    const BlobCache cache(folder);
    const auto blob = bytes("a large result");
    std::optional<BlobCache::Incoming> incoming(cache.receive(content_hash(blob), blob.size()));
    incoming->take(0, bytes("a lar"));
    incoming.emplace(cache.receive(content_hash(blob), blob.size()));
    EXPECT_TRUE(incoming->take(0, blob));
    incoming.reset();
    EXPECT_EQ(*cache.read(content_hash(blob)), blob);
}

TEST_F(BlobCacheTest, GivesNoDamagedBytesAndRemovesThem) {
    BlobCache cache(folder);
    const auto blob = bytes("a texture");
    keep(cache, blob);
    std::ofstream(folder / to_hex(content_hash(blob))) << "something else";
    EXPECT_FALSE(cache.has(content_hash(blob)));
    EXPECT_TRUE(holds_nothing(folder));
}

TEST_F(BlobCacheTest, RemovesWhatWasNotReadForTheLongestTime) {
    BlobCache cache(folder, 20);
    const auto old = bytes("0123456789"), recent = bytes("abcdefghij"), last = bytes("ABCDEFGHIJ");
    for (const auto& blob : {old, recent, last}) keep(cache, blob);
    const auto now = fs::file_time_type::clock::now();
    fs::last_write_time(folder / to_hex(content_hash(old)), now - std::chrono::hours(2));
    cache.trim();
    EXPECT_FALSE(cache.has(content_hash(old)));
    EXPECT_TRUE(cache.has(content_hash(recent)));
    EXPECT_TRUE(cache.has(content_hash(last)));
}

TEST_F(BlobCacheTest, ReadsTheFilesOfAJobAndNoOthers) {
    BlobCache cache(folder);
    const auto blob = bytes("WorldBegin");
    keep(cache, blob);
    const std::vector<JobFile> files{{"scenes/box.pbrt", content_hash(blob), blob.size()}};
    BlobFiles sent(cache, files);
    EXPECT_EQ(*sent.read("scenes/box.pbrt"), blob);
    EXPECT_THROW(sent.read("/etc/passwd"), Error);
    EXPECT_EQ(sent.like("Scenes/BOX.pbrt"), "scenes/box.pbrt");
    EXPECT_FALSE(sent.like("scenes/boxes.pbrt"));
}

// A file that was never sent is one that the launcher lacks, too; one that is lost must not look like that.
TEST_F(BlobCacheTest, TellsLostFilesFromThoseThatNeverWere) {
    const BlobCache cache(folder);
    const std::vector<JobFile> files{{"a.png", content_hash(bytes("lost")), 4}};
    BlobFiles sent(cache, files);
    EXPECT_THROW(sent.read("a.png"), MissingHere);
    try {
        sent.read("b.png");
    } catch (const MissingHere&) {
        ADD_FAILURE() << "it was never sent";
    } catch (const Error&) {
    }
}

}  // namespace
}  // namespace lightnet::blob_cache_test
