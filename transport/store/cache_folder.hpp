// The folder of a cache: whose it is, and which of its files are ours.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace lightnet {

/// Makes the folder (mode 0700) and marks it as a cache, or takes one that is marked or empty, as it is. Throws Error:
/// it holds other things, as files of a cache are removed when it is full, or it can't be made.
void open_cache_folder(const std::string& folder);

/// The folder of a cache that is in use. A user may well empty it meanwhile; it is to be a cache still when it is
/// opened again. Any thread.
class CacheMark {
public:
    /// Opens it, see open_cache_folder().
    explicit CacheMark(const std::string& folder);
    /// Before something is put there: puts the mark back where the folder is there and the mark is not. Throws nothing.
    void renew() const noexcept;

private:
    std::string folder_;
    std::uint64_t device_ = 0, number_ = 0;  // of the folder: another of its name is none of ours
};

/// Where blobs are kept when nothing else is said: $XDG_CACHE_HOME/lightnet, or ~/.cache/lightnet. Without HOME a
/// folder in /tmp stands in; throws Error when that is not this user's alone.
std::string default_cache_folder();

/// A file of ours in a cache.
struct CacheFile {
    std::filesystem::path path;
    std::uint64_t size = 0;
    std::filesystem::file_time_type used;
    bool partial = false;  // on its way in, or left behind on it
};

/// Regular files in `folder` that bear names that we give: 64 hexadecimal digits, and parts of such. None where it is a
/// link to another folder.
std::vector<CacheFile> files_of_ours(const std::filesystem::path& folder);

}  // namespace lightnet
