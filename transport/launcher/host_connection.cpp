#include "transport/launcher/host_connection.hpp"

#include <utility>

namespace lightnet {

CalledConnection::CalledConnection(const SocketContext& context, std::string endpoint)
    : context_(context), endpoint_(std::move(endpoint)) {
    for (auto* lane : {&work_, &files_}) lane->socket.emplace(asking_socket(context_, endpoint_));
}

bool CalledConnection::open(Lane& lane) {
    if (lane.socket) return true;
    try {
        lane = Lane{asking_socket(context_, endpoint_), false};
        return true;
    } catch (const SocketError&) {  // out of descriptors, say
        return false;
    }
}

bool CalledConnection::send(Frames& frames, bool files) {
    auto& lane = files ? files_ : work_;
    return open(lane) && lane.socket->send(frames);
}

std::optional<Frames> CalledConnection::Lane::receive() {
    auto frames = socket ? socket->receive() : std::nullopt;
    if (frames && is_empty(*frames) && !std::exchange(greeted, true)) return receive();
    return frames;
}

std::optional<Frames> CalledConnection::receive() {
    auto frames = work_.receive();
    return frames ? std::move(frames) : files_.receive();
}

void CalledConnection::renew() {
    // The old ones go first: there may be no descriptors for both.
    for (auto* lane : {&work_, &files_}) *lane = {};
    for (auto* lane : {&work_, &files_}) open(*lane);
}

void CalledConnection::watch(Poll& poll) const {
    for (const auto* lane : {&work_, &files_})
        if (lane->socket) poll.add(*lane->socket);
}

bool JoinedConnection::send(Frames& frames, bool) {
    frames.emplace(frames.begin(), route_);
    if (door_.send(frames)) return true;
    frames.erase(frames.begin());
    return false;
}

std::optional<Frames> JoinedConnection::receive() {
    if (arrived_.empty()) return std::nullopt;
    auto frames = std::move(arrived_.front());
    arrived_.pop_front();
    return frames;
}

void JoinedConnection::renew() { arrived_.clear(); }

void JoinedConnection::use(std::string route) {
    route_ = std::move(route);
    arrived_.clear();
}

void JoinedConnection::arrived(Frames frames) { arrived_.push_back(std::move(frames)); }

}  // namespace lightnet
