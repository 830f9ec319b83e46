#include "tools/support/single_instance.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <thread>

#include "core/base/error.hpp"

namespace lightnet {
namespace {

std::string folder_of_locks() {
    if (const char* folder = std::getenv("XDG_RUNTIME_DIR"); folder && *folder) return folder;
    const std::string folder = "/tmp/lightnetd-" + std::to_string(getuid());
    ::mkdir(folder.c_str(), 0700);
    struct stat found {};
    if (::lstat(folder.c_str(), &found) != 0 || !S_ISDIR(found.st_mode) || found.st_uid != getuid())
        throw Error(folder, "is no folder of this user, so no lock can be made there");
    return folder;
}

}  // namespace

SingleInstance::SingleInstance(const std::string& name, const std::atomic<bool>& stop) {
    if (name.empty() || name.find('/') != std::string::npos) throw Error(name, "is no name for a lock");
    const auto path = folder_of_locks() + "/" + name + ".lock";
    file_ = ::open(path.c_str(), O_CREAT | O_RDWR | O_CLOEXEC | O_NOFOLLOW, 0600);
    if (file_ < 0) throw Error(path, std::string("can't be opened: ") + std::strerror(errno));
    while (::flock(file_, LOCK_EX | LOCK_NB) != 0 && !stop) {
        if (errno != EWOULDBLOCK && errno != EINTR)
            throw Error(path, std::string("can't be locked: ") + std::strerror(errno));
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
}

SingleInstance::~SingleInstance() { ::close(file_); }

}  // namespace lightnet
