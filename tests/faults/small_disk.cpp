#include "tests/faults/small_disk.hpp"

#include <fcntl.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <vector>

namespace lightnet::test {
namespace {

constexpr std::size_t kilobyte = 1024;

// Mounts of our own, which nobody else sees. Once for the process.
bool alone() {
    static const bool made =
        ::unshare(CLONE_NEWNS) == 0 && ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0;
    return made;
}

std::size_t room_at(const std::filesystem::path& at) {
    struct statvfs found {};
    ::statvfs(at.c_str(), &found);
    return found.f_bavail * found.f_frsize;
}

}  // namespace

std::string SmallDisk::obstacle() { return alone() ? "" : "mounting a small disk is not allowed here"; }

SmallDisk::SmallDisk(std::filesystem::path at, std::size_t kilobytes) : at_(std::move(at)) {
    std::filesystem::create_directories(at_);
    const auto size = "size=" + std::to_string(kilobytes) + "k";
    if (!alone() || ::mount("none", at_.c_str(), "tmpfs", 0, size.c_str()) != 0)
        throw std::runtime_error("no small disk: " + std::string(std::strerror(errno)));
}

SmallDisk::~SmallDisk() { ::umount2(at_.c_str(), MNT_DETACH); }

void SmallDisk::leave(std::size_t kilobytes) const {
    const int file = ::open((at_ / "filler").c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
    const std::vector<char> page(4 * kilobyte, 'x');
    while (room_at(at_) > kilobytes * kilobyte)
        if (::write(file, page.data(), page.size()) <= 0) break;
    ::close(file);
}

void SmallDisk::clear() const { std::filesystem::remove(at_ / "filler"); }

void SmallDisk::protect() const {
    if (::mount("none", at_.c_str(), nullptr, MS_REMOUNT | MS_RDONLY, nullptr) != 0)
        throw std::runtime_error("the disk can't be protected: " + std::string(std::strerror(errno)));
}

}  // namespace lightnet::test
