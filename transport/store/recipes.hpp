// The store of recipes on disk: which blob was made by which (the hash of all that it depends on).
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "core/base/hash.hpp"

namespace lightnet {

/// The folder of recipes in the folder of a cache: one file each, named by the recipe's hash.
std::string recipes_in(const std::string& cache);

/// Is it one, sound or damaged? Others name their files by hashes, too.
bool is_recipe(const std::filesystem::path& file);

/// The blob that a recipe has made. The file says itself of which recipe it is, with a check sum: one that was swapped,
/// copied or changed names nothing.
std::optional<Hash> read_recipe(const std::string& folder, const Hash& recipe);

/// Writes it, whole or not at all. Throws Error.
void write_recipe(const std::string& folder, const Hash& recipe, const Hash& blob);

/// Removes those that name no blob that is there, and nothing else.
void trim_recipes(const std::string& folder, const std::function<bool(const Hash&)>& is_there);

}  // namespace lightnet
