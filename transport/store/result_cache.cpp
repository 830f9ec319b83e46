#include "transport/store/result_cache.hpp"

#include <filesystem>
#include <system_error>

#include "core/base/error.hpp"
#include "transport/store/recipes.hpp"

namespace lightnet {

namespace fs = std::filesystem;

DiskResultCache::DiskResultCache(const std::string& folder, std::uint64_t most_bytes)
    : blobs_(folder, most_bytes), recipes_(recipes_in(folder)) {
    std::error_code error;
    fs::create_directories(recipes_, error);
    if (error) throw Error(recipes_, "no folder for the cache can be made: " + error.message());
    if (!fs::is_directory(fs::symlink_status(recipes_, error)))
        throw Error(recipes_, "is a link to another folder, and files of a cache are removed when they are too many");
    blobs_.trim();
}

DiskResultCache::~DiskResultCache() {
    keeping_.clear();
    blobs_.trim();
}

Result DiskResultCache::find(const Hash& recipe) const {
    const auto blob = read_recipe(recipes_, recipe);
    if (!blob) return {};
    std::error_code ignored;
    fs::last_write_time(recipes_ + "/" + to_hex(recipe), fs::file_time_type::clock::now(), ignored);
    return {*blob, blobs_.read(*blob)};
}

void DiskResultCache::keep(const Hash& recipe, const Result& result) {
    const auto size = result.bytes->size();
    if (size > blobs_.most_bytes()) return;
    const auto work = [this, recipe, result, size] {
        try {
            blobs_.make_room(size);
            blobs_.store(result.name, *result.bytes);
            write_recipe(recipes_, recipe, result.name);
        } catch (const std::exception&) {
            // Not kept: the next run computes it again.
        }
    };
    try {
        keeping_.emplace_back(work);
    } catch (const std::system_error&) {  // no thread is to be had
        work();
    }
}

}  // namespace lightnet
