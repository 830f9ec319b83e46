#include "transport/zmq/poll.hpp"

#include <zmq.h>
#include <cerrno>

namespace lightnet {

Poll::Poll() = default;
Poll::~Poll() = default;

void Poll::add(const Socket& socket) { items_.push_back({socket.library(), 0, ZMQ_POLLIN, 0}); }
void Poll::add(int descriptor) { items_.push_back({nullptr, descriptor, ZMQ_POLLIN, 0}); }
std::size_t Poll::size() const { return items_.size(); }

void Poll::wait(std::chrono::milliseconds most) {
    if (zmq_poll(items_.data(), static_cast<int>(items_.size()), static_cast<long>(most.count())) < 0 &&
        zmq_errno() != EINTR)
        throw SocketError();
}

bool Poll::readable(std::size_t item) const { return (items_[item].revents & ZMQ_POLLIN) != 0; }

bool Poll::any_readable(std::size_t first, std::size_t last) const {
    for (std::size_t item = first; item < last; ++item)
        if (readable(item)) return true;
    return false;
}

}  // namespace lightnet
