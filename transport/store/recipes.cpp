#include "transport/store/recipes.hpp"

#include <filesystem>
#include <string_view>

#include "core/base/atomic_file.hpp"
#include "core/base/plain_file.hpp"
#include "transport/store/cache_folder.hpp"

namespace lightnet {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view beginning = "lightnet recipe ";
constexpr std::size_t longest_recipe = 4096;

// DECISIONS: recipes-say-what-of
std::string text_of(const Hash& recipe, const Hash& blob) {
    const std::string text = std::string(beginning) + "1\nrecipe " + to_hex(recipe) + "\nblob " + to_hex(blob) + "\n";
    return text + "sum " + to_hex(content_hash(text)) + "\n";
}

}  // namespace

std::string recipes_in(const std::string& cache) { return cache + "/recipes"; }

bool is_recipe(const fs::path& file) {
    const auto text = text_of_plain_file(file, longest_recipe);
    return text && text->starts_with(beginning);
}

std::optional<Hash> read_recipe(const std::string& folder, const Hash& recipe) {
    const auto text = text_of_plain_file(folder + "/" + to_hex(recipe), longest_recipe);
    const auto at = text ? text->find("\nblob ") : std::string::npos;
    if (at == std::string::npos) return std::nullopt;
    const auto blob = hash_from_hex(text->substr(at + 6, 2 * sizeof(Hash::bytes)));
    return blob && *text == text_of(recipe, *blob) ? blob : std::nullopt;
}

void write_recipe(const std::string& folder, const Hash& recipe, const Hash& blob) {
    write_file(folder + "/" + to_hex(recipe), text_of(recipe, blob));
}

void trim_recipes(const std::string& folder, const std::function<bool(const Hash&)>& is_there) {
    for (const auto& file : files_of_ours(folder)) {
        const auto recipe = hash_from_hex(file.path.filename().string());
        const auto blob = recipe ? read_recipe(folder, *recipe) : std::nullopt;
        std::error_code ignored;
        if (!file.partial && !(blob && is_there(*blob)) && is_recipe(file.path)) fs::remove(file.path, ignored);
    }
}

}  // namespace lightnet
