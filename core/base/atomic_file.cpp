#include "core/base/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <random>
#include <string>
#include <system_error>
#include <utility>

#include "core/base/error.hpp"

namespace lightnet {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const char* what) {
    const int reason = errno;
    throw Error(path.string(), fmt::format("{}: {}", what, std::generic_category().message(reason)));
}

/// A temporary file that is gone at the end of its scope unless it was renamed.
class TemporaryFile {
public:
    explicit TemporaryFile(const std::filesystem::path& target) : target_(target) {
        std::random_device random;  // a name, and nothing else
        do {
            name_ = fmt::format("{}.{:08x}", target.string(), random());
            // With the rights of any other new file: the system knows the mask, which no thread may look at.
            file_ = ::open(name_.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
        } while (file_ < 0 && errno == EEXIST);
        if (file_ < 0) fail(target_, "can't be written");
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    ~TemporaryFile() {
        if (file_ >= 0) ::close(file_);
        if (!name_.empty()) ::unlink(name_.c_str());
    }

    void write(std::string_view bytes) {
        while (!bytes.empty()) {
            const auto written = ::write(file_, bytes.data(), bytes.size());
            if (written < 0 && errno == EINTR) continue;
            if (written < 0) fail(target_, "could not be written");
            bytes.remove_prefix(static_cast<std::size_t>(written));
        }
    }

    void become_target() {
        if (::fsync(file_) != 0) fail(target_, "could not be synced to the disk");
        if (::close(std::exchange(file_, -1)) != 0) fail(target_, "could not be written");
        if (::rename(name_.c_str(), target_.c_str()) != 0) fail(target_, "could not be renamed to its name");
        name_.clear();
    }

private:
    std::filesystem::path target_;
    std::string name_;
    int file_ = -1;
};

// Without this a power cut may undo the rename. Not every file system can do it, and the file itself is whole anyhow.
void sync_folder(const std::filesystem::path& folder) {
    const int handle = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (handle < 0) return;
    ::fsync(handle);
    ::close(handle);
}

}  // namespace

// DECISIONS: written-whole
void write_file(const std::filesystem::path& path, std::string_view bytes) { write_file(path, std::span(&bytes, 1)); }

void write_file(const std::filesystem::path& path, std::span<const std::string_view> pieces) {
    TemporaryFile file(path);
    for (const auto piece : pieces) file.write(piece);
    file.become_target();
    sync_folder(path.parent_path());
}

}  // namespace lightnet
