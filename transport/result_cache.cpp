#include "transport/result_cache.hpp"

#include <filesystem>
#include <fstream>

#include "core/error.hpp"
#include "core/film/atomic_file.hpp"

namespace lightnet {

DiskResultCache::DiskResultCache(const std::string& folder) : blobs_(folder), recipes_(folder + "/recipes") {
    std::error_code error;
    std::filesystem::create_directories(recipes_, error);
    if (error) throw Error(recipes_, "no folder for the cache can be made: " + error.message());
    blobs_.trim();
}

Result DiskResultCache::find(const Hash& recipe) const {
    std::ifstream in(recipes_ + "/" + to_hex(recipe));
    std::string name;
    const auto hash = in >> name ? hash_from_hex(name) : std::nullopt;
    return hash ? Result{*hash, blobs_.read(*hash)} : Result{};
}

void DiskResultCache::keep(const Hash& recipe, const Result& result) {
    keeping_.emplace_back([this, recipe, result] {
        try {
            blobs_.store(result.name, *result.bytes);
            write_file(recipes_ + "/" + to_hex(recipe), to_hex(result.name) + "\n");
        } catch (const std::exception&) {
            // Not kept: the next run computes it again.
        }
    });
}

}  // namespace lightnet
