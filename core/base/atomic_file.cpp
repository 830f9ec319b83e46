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

/// A temporary file that is gone at the end of its scope unless it became its target.
class TemporaryFile {
public:
    // With `rights`, as far as the system's mask lets them: that no thread may look at.
    TemporaryFile(const std::filesystem::path& target, mode_t rights) : target_(target) {
        if (open_nameless(rights)) return;
        with_a_name([&] {
            file_ = ::open(name_.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, rights);
            return file_ >= 0;
        });
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

    void become_target(bool synced) {
        finish(synced);
        if (::rename(name_.c_str(), target_.c_str()) != 0) fail(target_, "could not be renamed to its name");
        name_.clear();
    }

    // False: something is there.
    bool become_new_target() {
        finish(true);
        if (::link(name_.c_str(), target_.c_str()) == 0) return true;
        if (errno != EEXIST) fail(target_, "could not be given its name");
        return false;
    }

private:
    // In the folder of the target, on file systems that know such files.
    bool open_nameless(mode_t rights) {
        const auto folder = target_.parent_path();
        file_ = ::open(folder.empty() ? "." : folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, rights);
        if (file_ < 0) return false;
        way_to_file_ = fmt::format("/proc/self/fd/{}", file_);
        if (::access(way_to_file_.c_str(), F_OK) == 0) return true;
        ::close(std::exchange(file_, -1));
        way_to_file_.clear();
        return false;
    }

    template <class Make>
    void with_a_name(Make make) {
        std::random_device random;  // a name, and nothing else
        do {
            name_ = fmt::format("{}.{:08x}", target_.string(), random());
            if (make()) return;
        } while (errno == EEXIST);
        name_.clear();
        fail(target_, "can't be written");
    }

    // All is on the disk, or on its way there, under a name of its own.
    void finish(bool synced) {
        if (synced && ::fsync(file_) != 0) fail(target_, "could not be synced to the disk");
        if (!way_to_file_.empty())
            with_a_name([&] {
                return ::linkat(AT_FDCWD, way_to_file_.c_str(), AT_FDCWD, name_.c_str(), AT_SYMLINK_FOLLOW) == 0;
            });
        if (::close(std::exchange(file_, -1)) != 0) fail(target_, "could not be written");
    }

    std::filesystem::path target_;
    std::string name_;         // "": none yet
    std::string way_to_file_;  // that it can be given one by; "": it was born with one
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
    TemporaryFile file(path, 0666);
    for (const auto piece : pieces) file.write(piece);
    file.become_target(true);
    sync_folder(path.parent_path());
}

void write_file_unsynced(const std::filesystem::path& path, std::string_view bytes) {
    TemporaryFile file(path, 0666);
    file.write(bytes);
    file.become_target(false);
}

bool write_new_secret(const std::filesystem::path& path, std::string_view bytes) {
    TemporaryFile file(path, 0600);
    file.write(bytes);
    const bool made = file.become_new_target();
    sync_folder(path.parent_path());
    return made;
}

}  // namespace lightnet
