#include "transport/lines/poll.hpp"

#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "transport/lines/line_error.hpp"

namespace lightnet {

Poll::Poll() = default;
Poll::~Poll() = default;

void Poll::add(const Waitable& socket) {
    items_.push_back({&socket, false});
    descriptors_.push_back({socket.descriptor(), POLLIN, 0});
}

void Poll::add(FrameQueue& queue) {
    items_.push_back({nullptr, false, &queue});
    descriptors_.push_back({queue.handle(), POLLIN, 0});
}

void Poll::add(int descriptor) {
    items_.push_back({nullptr, false});
    descriptors_.push_back({descriptor, POLLIN, 0});
}

// zmq_poll() looks into every socket twice, by a call of the system each. Here only those are looked into of which it
// is not known that there is nothing in them, and those whose descriptor tells.
// DECISIONS: quiet-sockets
void Poll::wait(std::chrono::milliseconds most) {
    using Clock = std::chrono::steady_clock;
    const bool found = look_into_each();
    const auto end = Clock::now() + most;
    auto left = found ? std::chrono::milliseconds(0) : most;
    do {
        if (look_at_descriptors(left) || found) break;
        left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now());
    } while (left.count() > 0);
    wake_up();
}

bool Poll::look_into_each() {
    bool found = false;
    for (auto& [socket, readable, queue] : items_) {
        readable = queue ? !queue->fall_asleep() : socket && !socket->quiet() && socket->readable();
        found |= readable;
    }
    return found;
}

void Poll::wake_up() {
    for (const auto& item : items_)
        if (item.queue) item.queue->wake_up();
}

// False: nothing is readable, and no signal came: the library had something to do for itself, or time is up.
bool Poll::look_at_descriptors(std::chrono::milliseconds most) {
    const int told = poll(descriptors_.data(), descriptors_.size(), static_cast<int>(most.count()));
    if (told < 0 && errno == EINTR) return true;
    if (told < 0) throw LineError(errno, std::strerror(errno));
    bool found = false;
    for (std::size_t i = 0; i < items_.size(); ++i) {
        auto& [socket, readable, queue] = items_[i];
        if (readable || descriptors_[i].revents == 0) continue;
        readable = !socket || socket->readable();
        found |= readable;
    }
    return found;
}

bool Poll::any_readable(std::size_t first, std::size_t last) const {
    return std::any_of(items_.begin() + static_cast<std::ptrdiff_t>(first),
                       items_.begin() + static_cast<std::ptrdiff_t>(last),
                       [](const Item& item) { return item.readable; });
}

}  // namespace lightnet
