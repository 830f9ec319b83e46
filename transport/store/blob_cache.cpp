#include "transport/store/blob_cache.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <random>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/plain_file.hpp"
#include "transport/store/recipes.hpp"

namespace lightnet {
namespace {

namespace fs = std::filesystem;

constexpr auto given_up = std::chrono::hours(24);  // what was not written to for so long comes no more

// Null: there is no such file, or something else, such as a pipe that would never end.
Bytes read_file(const std::string& path) try {
    PlainFile file(path, std::numeric_limits<std::uint64_t>::max(), PlainFile::Links::refused);
    return std::make_shared<std::vector<std::byte>>(file.bytes());
} catch (const Error&) {
    return nullptr;
}

// What bears the name of a blob is one when it holds what its name says; others name their files in this way, too.
bool is_blob(const CacheFile& file) {
    const auto name = hash_from_hex(file.path.filename().string());
    return name && hash_of_plain_file(file.path) == name;
}

// False: it is none of ours, and stays.
bool remove(const CacheFile& file, const fs::path& recipes) {
    std::error_code ignored;
    const bool ours = file.partial || (file.path.parent_path() == recipes ? is_recipe(file.path) : is_blob(file));
    return ours && fs::remove(file.path, ignored);
}

}  // namespace

BlobCache::BlobCache(std::string folder, std::uint64_t most_bytes)
    : folder_(std::move(folder)), mark_(folder_), most_bytes_(most_bytes) {}

std::string BlobCache::path_of(const Hash& hash) const { return folder_ + "/" + to_hex(hash); }

bool BlobCache::has(const Hash& hash) const { return read(hash) != nullptr; }

Bytes BlobCache::read(const Hash& hash) const {
    const auto path = path_of(hash);
    auto bytes = read_file(path);
    std::error_code ignored;
    if (!bytes) return nullptr;
    if (content_hash(*bytes) != hash) {
        fs::remove(path, ignored);
        return nullptr;
    }
    fs::last_write_time(path, fs::file_time_type::clock::now(), ignored);
    return bytes;
}

BlobCache::Incoming BlobCache::receive(const Hash& hash, std::uint64_t size) const {
    mark_.renew();
    Incoming incoming(path_of(hash), hash, size);
    // Not while it is being made: a buffer that finds no memory would leave the file behind.
    incoming.file_.open(incoming.partial_, std::ios::binary | std::ios::trunc);
    return incoming;
}

CacheClaim BlobCache::claim() const {
    mark_.renew();
    return CacheClaim(folder_);
}

BlobCache::Incoming::Incoming(std::string path, const Hash& hash, std::uint64_t size)
    : path_(std::move(path)),
      // one of its own: a blob may come from its beginning again before the first attempt is given up
      partial_(path_ + ".part-" + std::to_string(getpid()) + "-" + std::to_string(std::random_device()())),
      pieces_(hash, size) {}

BlobCache::Incoming::Incoming(Incoming&& other) noexcept
    : path_(std::move(other.path_)),
      partial_(std::exchange(other.partial_, {})),
      pieces_(std::move(other.pieces_)),
      file_(std::move(other.file_)) {}

BlobCache::Incoming::~Incoming() {
    std::error_code ignored;
    if (!partial_.empty()) fs::remove(partial_, ignored);
}

void BlobCache::store(const Hash& hash, std::span<const std::byte> blob) const {
    auto incoming = receive(hash, blob.size());
    incoming.write(blob);
    incoming.appear();
}

bool BlobCache::Incoming::take(std::uint64_t offset, std::span<const std::byte> piece) {
    const auto fresh = pieces_.take(offset, piece);
    if (pieces_.state() == Arrival::too_long) throw Error("a file of the scene is longer than it was said to be");
    if (pieces_.state() == Arrival::damaged) throw Error("a file of the scene arrived damaged");
    write(fresh);
    const bool whole = pieces_.state() == Arrival::whole;
    if (whole) appear();
    return whole;
}

void BlobCache::Incoming::write(std::span<const std::byte> piece) {
    file_.write(reinterpret_cast<const char*>(piece.data()), static_cast<std::streamsize>(piece.size()));
    if (!file_) throw Error(partial_, "can't be written");
}

void BlobCache::Incoming::appear() {
    file_.close();
    std::error_code error;
    if (file_.fail()) throw Error(partial_, "can't be written");
    fs::rename(partial_, path_, error);
    if (error) throw Error(path_, "can't be kept: " + error.message());
    partial_.clear();
}

void BlobCache::make_room(std::uint64_t bytes) const {
    const auto claimed = claimed_in(folder_);
    const auto most = most_bytes_ - std::min(most_bytes_, bytes);
    auto files = files_of_ours(folder_);
    const auto recipes = recipes_in(folder_);
    for (auto& file : files_of_ours(recipes)) files.push_back(std::move(file));
    const auto now = fs::file_time_type::clock::now();
    for (const auto& file : files)
        if (file.partial && now - file.used > given_up) remove(file, recipes);
    std::erase_if(files, [&](const auto& file) {
        const auto name = file.partial ? std::nullopt : hash_from_hex(file.path.filename().string());
        return !name || claimed.contains(*name);
    });
    std::uint64_t sum = 0;
    for (const auto& file : files) sum += file.size;
    std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) { return a.used < b.used; });
    for (const auto& file : files)
        if (sum <= most)
            break;
        else if (remove(file, recipes))
            sum -= file.size;
    trim_recipes(recipes, [this](const Hash& blob) {
        std::error_code ignored;
        return fs::exists(path_of(blob), ignored);
    });
}

Bytes BlobFiles::read(const std::string& path) {
    const auto found = std::find_if(files_.begin(), files_.end(), [&](const auto& file) { return file.path == path; });
    if (found == files_.end()) throw Error(path, "no such file among those that were sent");
    auto bytes = cache_.read(found->hash);
    if (!bytes) throw MissingHere(path, "the cache has lost it");
    return bytes;
}

std::optional<std::string> BlobFiles::like(const std::string& path) {
    std::optional<std::string> first;
    for (const JobFile& file : files_)
        if (same_but_for_case(file.path, path) && (!first || file.path < *first)) first = file.path;
    return first;
}

}  // namespace lightnet
