// A cache removes files when it is full: only its own, and only where it may.
#include "transport/store/cache_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <span>

#include "core/base/error.hpp"
#include "tests/support/folder.hpp"
#include "transport/store/blob_cache.hpp"
#include "transport/store/result_cache.hpp"

namespace lightnet::cache_folder_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

std::string refusal_of(const std::string& folder) {
    try {
        const BlobCache cache(folder);
        return "";
    } catch (const Error& error) {
        return error.what();
    }
}

mode_t rights_of(const fs::path& path) {
    struct stat about {};
    ::stat(path.c_str(), &about);
    return about.st_mode & 0777;
}

const std::string blob_name(64, 'a');

TEST(CacheFolder, IsMadeForThisUserAloneAndMarked) {
    const test::Folder home;
    const auto folder = home / "some" / "cache";
    EXPECT_EQ(refusal_of(folder), "");
    EXPECT_EQ(rights_of(folder), 0700u);
    std::ifstream tag(folder / "CACHEDIR.TAG");
    std::string line;
    std::getline(tag, line);
    EXPECT_EQ(line, "Signature: 8a477f597d28d172789f06886806bc55") << "programs that make backups know it";
    EXPECT_EQ(refusal_of(folder), "") << "a second time";
}

TEST(CacheFolder, IsNoneThatHoldsFilesOfOthers) {
    const test::Folder home;
    for (const std::string name : {"thesis.tex", ".hidden", blob_name.c_str(), "recipes/x", "CACHEDIR.TAG"}) {
        const auto folder = home / std::to_string(std::hash<std::string>{}(name));
        home.write((folder / name).string(), "Signature: 8a477f597d28d172789f06886806bc55\nof another program");
        fs::permissions(folder, fs::perms(0755));
        const auto first = name.substr(0, name.find('/'));
        EXPECT_THAT(refusal_of(folder), HasSubstr("it holds '" + first + "'")) << name;
        EXPECT_TRUE(fs::exists(folder / name));
        EXPECT_EQ(rights_of(folder), 0755u) << name;
    }
    home.write("file", "text");
    EXPECT_THAT(refusal_of(home / "file"), HasSubstr("is no folder"));
}

TEST(CacheFolder, MayBeAnEmptyOneWhoseRightsStay) {
    const test::Folder home;
    const auto folder = home / "shared";
    fs::create_directory(folder);
    fs::permissions(folder, fs::perms(0770));
    EXPECT_EQ(refusal_of(folder), "");
    EXPECT_EQ(rights_of(folder), 0770u);
}

TEST(CacheFolder, IsNoneThatHoldsFilesOfOthersWithNamesLikeOurs) {
    const test::Folder home;
    const std::string text = "a photograph", name = to_hex(content_hash(text));
    home.write("lightnet-assets/" + name, text);
    EXPECT_THAT(refusal_of(home / "lightnet-assets"), HasSubstr("it holds '" + name + "'"));
    home.write("lightnet/recipes/" + name, text);
    EXPECT_THAT(refusal_of(home / "lightnet"), HasSubstr("it holds 'recipes'"));
    EXPECT_TRUE(fs::exists(home / "lightnet-assets" / name));
}

TEST(CacheFolder, IsNotMarkedByALink) {
    const test::Folder home;
    EXPECT_EQ(refusal_of(home / "cache"), "");
    home.write("photos/1.jpg", "mine");
    fs::create_symlink(home / "cache" / "CACHEDIR.TAG", home / "photos" / "CACHEDIR.TAG");
    EXPECT_THAT(refusal_of(home / "photos"), HasSubstr("is no cache of lightnet's"));
}

TEST(BlobCache, FollowsNoLinks) {
    const test::Folder home;
    const auto folder = home / "cache";
    const BlobCache cache(folder, 0);
    const std::string text = "a photograph";
    const Hash hash = content_hash(text);
    home.write("store/" + to_hex(hash), text);
    fs::create_symlink(home / "store", folder / "recipes");
    fs::create_symlink(home / "store" / to_hex(hash), folder / to_hex(hash));
    EXPECT_FALSE(cache.has(hash)) << "it may be a link to what nobody should be sent";
    cache.trim();
    EXPECT_TRUE(fs::exists(home / "store" / to_hex(hash)));
    EXPECT_THROW(DiskResultCache(folder.string(), 0), Error) << "and says what is in the way";
    EXPECT_TRUE(fs::exists(home / "store" / to_hex(hash)));
}

TEST(BlobCache, LeavesFilesOfOthersAmongItsOwn) {
    const test::Folder home;
    const auto folder = home / "cache";
    const DiskResultCache results(folder, 0);
    const auto foreign = folder / std::string(64, 'c'), recipe = folder / "recipes" / std::string(64, 'f');
    for (const auto& file : {foreign, recipe}) std::ofstream(file) << "named by another hash than ours";
    const BlobCache cache(folder, 0);
    cache.store(content_hash(std::string_view("a mesh")), std::as_bytes(std::span("a mesh", 6)));
    cache.trim();
    EXPECT_FALSE(cache.has(content_hash(std::string_view("a mesh"))));
    for (const auto& file : {foreign, recipe}) EXPECT_TRUE(fs::exists(file)) << file;
}

TEST(BlobCache, LeavesFilesOfOthersAlone) {
    const test::Folder home;
    const auto folder = home / "cache";
    const BlobCache cache(folder, 0);
    fs::permissions(folder, fs::perms(0750));
    const std::vector<std::string> foreign{"thesis.tex", blob_name + "b", std::string(64, 'A'), blob_name + ".part-1",
                                           blob_name + ".tar"};
    for (const auto& name : foreign) std::ofstream(folder / name) << "mine";
    fs::create_directory(folder / std::string(64, 'd'));
    fs::create_symlink(folder / "thesis.tex", folder / std::string(64, 'e'));
    const auto blob = to_hex(content_hash(std::string_view("a blob")));
    std::ofstream(folder / blob) << "a blob";
    const BlobCache again(folder, 0);
    again.trim();
    for (const auto& name : foreign) EXPECT_TRUE(fs::exists(folder / name)) << name;
    EXPECT_TRUE(fs::exists(folder / std::string(64, 'd')));
    EXPECT_TRUE(fs::is_symlink(folder / std::string(64, 'e')));
    EXPECT_FALSE(fs::exists(folder / blob));
    EXPECT_EQ(rights_of(folder), 0750u);
}

void empty(const fs::path& folder) {
    for (const auto& file : fs::directory_iterator(folder)) fs::remove_all(file.path());
}

TEST(CacheFolder, IsACacheStillWhenSomebodyHasEmptiedIt) {
    const test::Folder home;
    const auto folder = home / "cache";
    const std::string text = "a mesh";
    const auto use_of = std::map<std::string, std::function<void(const BlobCache&)>>{
        {"claimed", [](const BlobCache& cache) { (void)cache.claim(); }},
        {"filled", [&](const BlobCache& cache) {
             cache.store(content_hash(std::string_view(text)), std::as_bytes(std::span(text)));
         }}};
    for (const auto& [what, use] : use_of) {
        const BlobCache cache(folder);
        empty(folder);
        use(cache);
        std::ofstream(folder / "claim-17-4711");  // its process was killed
        EXPECT_EQ(refusal_of(folder), "") << what;
        empty(folder);
    }
}

TEST(CacheFolder, IsNoneThatAnotherHasMadeInItsPlace) {
    const test::Folder home;
    const auto folder = home / "cache";
    const BlobCache cache(folder);
    fs::rename(folder, home / "away");
    home.write((folder / "thesis.tex").string(), "");
    (void)cache.claim();
    EXPECT_THAT(refusal_of(folder), HasSubstr("is no cache of lightnet's"));
}

TEST(BlobCache, RemovesPartsThatWereLeftBehindLongAgo) {
    const test::Folder home;
    const auto folder = home / "cache";
    const BlobCache cache(folder);
    const auto old = folder / (blob_name + ".part-17-4711"), recent = folder / (blob_name + ".part-18-4711");
    for (const auto& part : {old, recent}) std::ofstream(part) << "half of it";
    fs::last_write_time(old, fs::file_time_type::clock::now() - std::chrono::hours(25));
    cache.trim();
    EXPECT_FALSE(fs::exists(old));
    EXPECT_TRUE(fs::exists(recent));
}

TEST(BlobCache, WaitsForNoPipe) {
    const test::Folder home;
    const BlobCache cache(home / "cache");
    const Hash hash = content_hash(std::string_view("a mesh"));
    ASSERT_EQ(::mkfifo((home / "cache" / to_hex(hash)).c_str(), 0600), 0);
    EXPECT_FALSE(cache.has(hash));
}

/// A variable of the environment is another one, or none, for a while.
class Environment {
public:
    explicit Environment(std::string name, const char* meanwhile = nullptr) : name_(std::move(name)) {
        if (const char* value = std::getenv(name_.c_str())) before_ = value;
        set(meanwhile);
    }
    ~Environment() { set(before_ ? before_->c_str() : nullptr); }
    Environment(const Environment&) = delete;
    Environment& operator=(const Environment&) = delete;

private:
    void set(const char* value) const {
        if (value)
            ::setenv(name_.c_str(), value, 1);
        else
            ::unsetenv(name_.c_str());
    }
    std::string name_;
    std::optional<std::string> before_;
};

TEST(CacheFolder, ThatStandsInForHomeMustBelongToThisUserAlone) {
    const test::Folder temporary;
    const Environment home("HOME"), cache("XDG_CACHE_HOME"), instead_of_tmp("TMPDIR", temporary.path().c_str());
    const auto folder = temporary / ("lightnet-cache-" + std::to_string(::getuid()));
    const auto refused = [] {
        try {
            default_cache_folder();
            return std::string();
        } catch (const Error& error) {
            return std::string(error.what());
        }
    };
    const test::Folder elsewhere;
    fs::create_symlink(elsewhere.path(), folder);
    EXPECT_THAT(refused(), HasSubstr("is not a folder of this user that nobody else may open"));
    fs::remove(folder);
    fs::create_directory(folder);
    fs::permissions(folder, fs::perms(0777));
    EXPECT_THAT(refused(), HasSubstr("set HOME"));
    if (::getuid() == 0) {
        fs::permissions(folder, fs::perms(0700));
        ASSERT_EQ(::chown(folder.c_str(), 65534, 65534), 0);
        EXPECT_THAT(refused(), HasSubstr("set HOME"));
    }
    fs::remove(folder);
    EXPECT_EQ(refused(), "");
    EXPECT_EQ(rights_of(folder), 0700u);
    fs::remove(folder);
}

}  // namespace
}  // namespace lightnet::cache_folder_test
