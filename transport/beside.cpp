#include "transport/beside.hpp"

#include <sys/eventfd.h>
#include <unistd.h>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstring>

#include "core/error.hpp"

namespace lightnet {

Beside::Beside() : handle_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
    if (handle_ < 0) throw Error(std::string("no handle to wait at: ") + std::strerror(errno));
}

Beside::~Beside() {
    under_way_.clear();
    close(handle_);
}

void Beside::clear() {
    std::uint64_t count;
    [[maybe_unused]] const auto taken = read(handle_, &count, sizeof count);  // nothing there is as good
    std::erase_if(under_way_,
                  [](const auto& one) { return one.wait_for(std::chrono::seconds(0)) == std::future_status::ready; });
}

void Beside::start_thread(std::function<void()> work) {
    under_way_.push_back(std::async(std::launch::async, [this, work = std::move(work)] {
        work();
        const std::uint64_t one = 1;
        [[maybe_unused]] const auto put = write(handle_, &one, sizeof one);  // can't fail before 2⁶⁴ of them
    }));
}

}  // namespace lightnet
