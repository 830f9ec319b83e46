#include "tools/support/spare_cache.hpp"

#include <unistd.h>

#include <exception>

#include "core/base/error.hpp"
#include "core/base/words_of.hpp"
#include "transport/store/cache_folder.hpp"

namespace lightnet {
namespace {

// "": nothing.
std::string what_is_wrong_with_the_usual_one() {
    try {
        const auto folder = default_cache_folder();
        open_cache_folder(folder);
        return ::access(folder.c_str(), W_OK | X_OK) == 0 ? "" : folder + " can't be written";
    } catch (const std::exception& error) {
        return words_of(error);
    }
}

}  // namespace

std::string cache_or_spare(std::optional<SpareCache>& spare, const std::string& who_keeps,
                           const std::function<void(const std::string&)>& say) {
    const auto wrong = what_is_wrong_with_the_usual_one();
    if (wrong.empty()) return {};
    spare.emplace("cache");
    say("warning: " + wrong + "; " + who_keeps + " files in " + spare->path() +
        " until the end; --cache FOLDER chooses a folder that stays");
    return spare->path();
}

}  // namespace lightnet
