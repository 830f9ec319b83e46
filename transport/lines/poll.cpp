#include "transport/lines/poll.hpp"

#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>

#include "transport/lines/line_error.hpp"
#include "transport/lines/look_first.hpp"

namespace lightnet {
namespace {

struct AsleepHere {
    AsleepHere() { AwakeThreads::of_process().go(); }
    ~AsleepHere() { AwakeThreads::of_process().come(); }
};

void count_this_thread() { thread_local const AwakeThreads::Told counted(1); }

}  // namespace

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
    count_this_thread();
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

void Poll::look_and_wait(std::chrono::milliseconds most) {
    count_this_thread();
    thread_local LookFirst first;
    if (!first.look([this] { return glance(); })) wait(most);
}

// Nobody falls asleep, so who pushes into a queue needs not wake anybody.
bool Poll::glance() {
    bool found = false;
    for (auto& [socket, readable, queue] : items_) {
        readable = queue ? !queue->empty() : socket && !socket->quiet() && socket->readable();
        found |= readable;
    }
    return look_at_descriptors(std::chrono::milliseconds(0)) || found;
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
    const auto told = [&] {
        std::optional<AsleepHere> asleep;
        if (most.count() > 0) asleep.emplace();
        return poll(descriptors_.data(), descriptors_.size(), static_cast<int>(most.count()));
    }();
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
