#include "transport/launcher/host_connection.hpp"

#include <utility>

namespace lightnet {
namespace {

constexpr auto old_line_lasts = std::chrono::seconds(10);  // for replies that are under way

}  // namespace

CalledConnection::CalledConnection(const SocketContext& context, std::string endpoint, std::optional<LineKeys> keys)
    : context_(context), endpoint_(std::move(endpoint)), keys_(std::move(keys)) {
    for (auto* lane : {&work_, &files_}) connect(*lane);
}

void CalledConnection::connect(Lane& lane) {
    lane = Lane{unconnected_asking_socket(context_, endpoint_, keys_), false};
    if (&lane == &work_ || &lane == &next_) note_handshakes(context_, *lane.socket);
    lane.socket->connect(endpoint_);
}

bool CalledConnection::open(Lane& lane) {
    if (lane.socket) return true;
    try {
        connect(lane);
        return true;
    } catch (const SocketError&) {  // out of descriptors, say
        lane = {};
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
    for (auto* lane : {&work_, &old_, &files_})
        if (auto frames = lane->receive()) return frames;
    return std::nullopt;
}

std::optional<Handshake> CalledConnection::look_at_handshake() {
    return work_.socket ? last_handshake(*work_.socket) : std::nullopt;
}

void CalledConnection::open_next() {
    if (!next_.socket) open(next_);
}

bool CalledConnection::send_on_next(Frames& frames) {
    if (!next_.socket || !next_.socket->send(frames)) return false;
    old_ = std::exchange(work_, std::exchange(next_, {}));
    old_since_ = std::chrono::steady_clock::now();
    return true;
}

bool CalledConnection::has_old(std::chrono::steady_clock::time_point now) {
    if (old_.socket && now - old_since_ > old_line_lasts) old_ = {};
    return old_.socket.has_value();
}

void CalledConnection::renew() {
    // The old ones go first: there may be no descriptors for both.
    for (auto* lane : {&work_, &files_, &next_, &old_}) *lane = {};
    for (auto* lane : {&work_, &files_}) open(*lane);
}

void CalledConnection::watch(Poll& poll) const {
    for (const auto* lane : {&work_, &files_, &next_, &old_})
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
