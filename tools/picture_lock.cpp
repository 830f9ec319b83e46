#include "tools/picture_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <fstream>

#include "core/base/error.hpp"
#include "core/base/printable.hpp"
#include "core/base/this_machine.hpp"

namespace lightnet {
namespace {

std::string this_process() { return "process " + std::to_string(::getpid()) + " on " + machine_name(); }

// As the one who has the lock wrote it.
std::string who_has(const std::string& path) {
    std::ifstream in(path);
    std::string who;
    std::getline(in, who);
    return who.empty() ? "" : " (" + printable(who.substr(0, 100)) + ")";
}

int open_lock(const std::string& path) {
    const int file = ::open(path.c_str(), O_CREAT | O_RDWR | O_CLOEXEC | O_NOFOLLOW, 0666);
    return file >= 0 ? file : ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);  // left behind by another user
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
            throw UserError({picture, 0}, "another run is writing this picture" + who_has(path_) +
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
