#include "tools/pictures/picture_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <span>
#include <string_view>

#include "core/base/error.hpp"
#include "core/base/plain_file.hpp"
#include "core/base/printable.hpp"
#include "core/base/this_machine.hpp"

namespace lightnet {
namespace {

constexpr std::string_view beginning = "process ";

std::string this_process() { return std::string(beginning) + std::to_string(::getpid()) + " on " + machine_name(); }

// As the one who has the lock wrote it.
std::string who_has(const std::string& path) {
    std::string who(100, '\0');
    try {
        who.resize(PlainFile(path, ~std::uint64_t{0}).read(std::as_writable_bytes(std::span(who))));
    } catch (const Error&) {
        return "";
    }
    who.resize(std::min(who.find('\n'), who.size()));
    return who.empty() ? "" : " (" + printable(who) + ")";
}

// What stands where the lock belongs, and is none: without it two runs would write one picture.
[[noreturn]] void complain_of(const std::string& path, const std::string& what) {
    throw UserError({path, 0}, what +
                                   ", and no lock of lightnet's: it is in the way of the lock on the picture (move it, "
                                   "or choose another name with -o)");
}

void expect_lock(const std::string& path, int file) {
    struct stat about {};
    if (::fstat(file, &about) != 0 || !S_ISREG(about.st_mode)) complain_of(path, "is a folder, a pipe or a device");
    std::string text(beginning.size(), '\0');
    const auto size = ::pread(file, text.data(), text.size(), 0);
    if (size > 0 && !beginning.starts_with(text.substr(0, static_cast<std::size_t>(size))))
        complain_of(path, "is a file of others");
}

// None, with errno: there can be none.
int open_lock(const std::string& path) {
    constexpr int ways = O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK;
    int file = ::open(path.c_str(), O_CREAT | O_RDWR | ways, 0666);
    if (file < 0) file = ::open(path.c_str(), O_RDONLY | ways);  // left behind by another user
    if (file < 0 && errno == ELOOP) complain_of(path, "is a link to something else");
    if (file < 0 && errno == ENXIO) complain_of(path, "is a socket or a device");
    if (file < 0) return file;
    try {
        expect_lock(path, file);
    } catch (...) {
        ::close(file);
        throw;
    }
    return file;
}

}  // namespace

PictureLock::PictureLock(const std::string& picture) {
    const std::filesystem::path path(picture);
    path_ = (path.parent_path() / ("." + path.filename().string() + ".lock")).string();
    while (true) {
        file_ = open_lock(path_);
        if (file_ < 0) return;
        // DECISIONS: lock-beside-the-picture
        if (::flock(file_, LOCK_EX | LOCK_NB) != 0) {
            const bool taken = errno == EWOULDBLOCK;
            ::close(file_);
            file_ = -1;
            if (!taken) return;
            throw PictureTaken({picture, 0}, "another run is writing this picture" + who_has(path_) +
                                                 ": wait for its end, or choose another name with -o");
        }
        if (still_there()) break;
        ::close(file_);  // its last owner has just removed it
    }
    const auto who = this_process() + "\n";
    if (::ftruncate(file_, 0) == 0 && ::write(file_, who.data(), who.size()) < 0)
        return;  // it locks without words, too
}

PictureLock::~PictureLock() {
    if (file_ < 0) return;
    if (still_there()) ::unlink(path_.c_str());
    ::close(file_);
}

bool PictureLock::still_there() const {
    struct stat mine {
    }, named{};
    return ::fstat(file_, &mine) == 0 && ::lstat(path_.c_str(), &named) == 0 && mine.st_ino == named.st_ino &&
           mine.st_dev == named.st_dev;
}

}  // namespace lightnet
