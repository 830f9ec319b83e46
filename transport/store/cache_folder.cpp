#include "transport/store/cache_folder.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <exception>
#include <optional>
#include <system_error>

#include "core/base/atomic_file.hpp"
#include "core/base/error.hpp"
#include "core/base/plain_file.hpp"

namespace lightnet {
namespace {

namespace fs = std::filesystem;

// Of the Cache Directory Tagging Specification, so that programs that make backups leave it out.
// DECISIONS: marked-caches
constexpr std::string_view mark_name = "CACHEDIR.TAG";
constexpr std::string_view mark =
    "Signature: 8a477f597d28d172789f06886806bc55\n"
    "# This folder is a cache of lightnet: it removes files here when they are too many.\n"
    "# See https://bford.info/cachedir/\n";
constexpr std::size_t longest_mark = 4096;

bool all_digits(std::string_view text, std::string_view digits) {
    return !text.empty() && text.find_first_not_of(digits) == text.npos;
}

constexpr std::string_view decimal = "0123456789", hexadecimal = "0123456789abcdef";

// What follows the 64 digits of a name of ours; none: it is no such name.
std::optional<std::string_view> after_hash(std::string_view name) {
    if (name.size() < 64 || !all_digits(name.substr(0, 64), hexadecimal)) return std::nullopt;
    return name.substr(64);
}

// ".part-PROCESS-NUMBER" of blobs, ".8digits" of what is written at once.
bool is_part(std::string_view ending) {
    if (ending.starts_with(".part-")) {
        const auto numbers = ending.substr(6);
        const auto dash = numbers.find('-');
        return dash != numbers.npos && all_digits(numbers.substr(0, dash), decimal) &&
               all_digits(numbers.substr(dash + 1), decimal);
    }
    return ending.size() == 9 && ending[0] == '.' && all_digits(ending.substr(1), hexadecimal);
}

bool is_marked(const fs::path& folder) {
    const auto text = text_of_plain_file(folder / mark_name, longest_mark);
    return text && text->starts_with(mark);
}

// Something in a folder without a mark, which is nobody's cache then, whatever its files are called: others name theirs
// by hashes, too. None: it may become one.
std::optional<std::string> foreign_name(const fs::path& folder) {
    std::error_code error;
    auto file = fs::directory_iterator(folder, error);
    if (error) throw Error(folder.string(), "can't be looked into: " + error.message());
    for (; file != fs::directory_iterator(); file.increment(error)) {
        const auto name = file->path().filename().string();
        const bool becomes_mark =
            name.starts_with(mark_name) && is_part(std::string_view(name).substr(mark_name.size()));
        if (!becomes_mark) return name;
    }
    return std::nullopt;
}

bool belongs_to_this_user_alone(const std::string& folder) {
    struct stat about {};
    return ::lstat(folder.c_str(), &about) == 0 && S_ISDIR(about.st_mode) && about.st_uid == ::getuid() &&
           (about.st_mode & 0777) == 0700;
}

}  // namespace

void open_cache_folder(const std::string& folder) {
    const fs::path path(folder);
    std::error_code error;
    if (path.has_parent_path()) fs::create_directories(path.parent_path(), error);
    if (::mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST)
        throw Error(folder, "no folder for the cache can be made: " + std::generic_category().message(errno));
    if (!fs::is_directory(path, error)) throw Error(folder, "is no folder, so no cache can be there");
    if (is_marked(path)) return;
    // Another process may have made it a cache just now.
    if (const auto foreign = foreign_name(path); foreign && !is_marked(path))
        throw Error(folder, "is no cache of lightnet's: it holds '" + *foreign +
                                "', and files of a cache are removed when they are too many; choose a new folder, or "
                                "an empty one, with --cache");
    write_file(path / mark_name, mark);
}

CacheMark::CacheMark(const std::string& folder) : folder_(folder) {
    open_cache_folder(folder);
    struct stat about {};
    if (::stat(folder.c_str(), &about) == 0) device_ = about.st_dev, number_ = about.st_ino;
}

void CacheMark::renew() const noexcept try {
    struct stat now {};
    if (is_marked(folder_) || ::stat(folder_.c_str(), &now) != 0) return;
    if (now.st_dev == device_ && now.st_ino == number_) write_file(fs::path(folder_) / mark_name, mark);
} catch (const std::exception&) {  // whoever puts something there will say what is wrong
}

std::string default_cache_folder() {
    if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && *cache) return std::string(cache) + "/lightnet";
    if (const char* home = std::getenv("HOME"); home && *home) return std::string(home) + "/.cache/lightnet";
    // Anybody may have made it, and could then choose what pictures are made of.
    const auto folder = (fs::temp_directory_path() / ("lightnet-cache-" + std::to_string(::getuid()))).string();
    ::mkdir(folder.c_str(), 0700);
    if (!belongs_to_this_user_alone(folder))
        throw Error(folder,
                    "stands in for a missing HOME, but is not a folder of this user that nobody else may open; set "
                    "HOME, or choose a folder with --cache");
    return folder;
}

std::vector<CacheFile> files_of_ours(const fs::path& folder) {
    std::vector<CacheFile> files;
    std::error_code error;
    if (!fs::is_directory(fs::symlink_status(folder, error))) return files;
    for (auto file = fs::directory_iterator(folder, error); !error && file != fs::directory_iterator();
         file.increment(error)) {
        const auto name = file->path().filename().string();
        const auto ending = after_hash(name);
        std::error_code gone;
        if (!ending || !(ending->empty() || is_part(*ending)) || !fs::is_regular_file(file->symlink_status(gone)))
            continue;
        CacheFile one{file->path(), file->file_size(gone), file->last_write_time(gone), !ending->empty()};
        if (!gone) files.push_back(std::move(one));
    }
    return files;
}

}  // namespace lightnet
