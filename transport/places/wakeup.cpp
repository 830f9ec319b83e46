#include "transport/places/wakeup.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <string>

#include "core/base/error.hpp"

namespace lightnet {

Wakeup::Wakeup() : handle_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
    if (handle_ < 0) throw Error(std::string("no handle to wait at: ") + std::strerror(errno));
}

Wakeup::~Wakeup() { close(handle_); }

void Wakeup::notify() const noexcept {
    const std::uint64_t one = 1;
    [[maybe_unused]] const auto put = write(handle_, &one, sizeof one);  // can't fail before 2⁶⁴ of them
}

void Wakeup::wait(std::chrono::milliseconds most) const noexcept {
    pollfd item{handle_, POLLIN, 0};
    poll(&item, 1, static_cast<int>(most.count()));
}

void Wakeup::clear() const noexcept {
    std::uint64_t count;
    [[maybe_unused]] const auto taken = read(handle_, &count, sizeof count);  // nothing there is as good
}

}  // namespace lightnet
