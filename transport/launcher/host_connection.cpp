#include "transport/launcher/host_connection.hpp"

#include <utility>
#include <zmq.hpp>

namespace lightnet {

CalledLine::CalledLine(zmq::context_t& context, std::string endpoint)
    : context_(context), endpoint_(std::move(endpoint)) {
    for (auto* lane : {&work_, &files_})
        lane->socket = std::make_unique<zmq::socket_t>(asking_socket(context_, endpoint_));
}

CalledLine::~CalledLine() = default;

bool CalledLine::open(Lane& lane) {
    if (lane.socket) return true;
    try {
        lane = Lane{std::make_unique<zmq::socket_t>(asking_socket(context_, endpoint_)), false};
        return true;
    } catch (const zmq::error_t&) {  // out of descriptors, say
        return false;
    }
}

bool CalledLine::send(Frames& frames, bool files) {
    auto& lane = files ? files_ : work_;
    return open(lane) && send_frames(*lane.socket, frames);
}

std::optional<Frames> CalledLine::Lane::receive() {
    auto frames = socket ? receive_frames(*socket) : std::nullopt;
    if (frames && is_empty(*frames) && !std::exchange(greeted, true)) return receive();
    return frames;
}

std::optional<Frames> CalledLine::receive() {
    auto frames = work_.receive();
    return frames ? std::move(frames) : files_.receive();
}

void CalledLine::renew() {
    // The old ones go first: there may be no descriptors for both.
    for (auto* lane : {&work_, &files_}) *lane = {};
    for (auto* lane : {&work_, &files_}) open(*lane);
}

std::vector<zmq::socket_t*> CalledLine::sockets() {
    std::vector<zmq::socket_t*> sockets;
    for (auto* lane : {&work_, &files_})
        if (lane->socket) sockets.push_back(lane->socket.get());
    return sockets;
}

JoinedLine::JoinedLine(zmq::socket_t& door, std::string route) : door_(door), route_(std::move(route)) {}
JoinedLine::~JoinedLine() = default;

bool JoinedLine::send(Frames& frames, bool) {
    frames.insert(frames.begin(), frame_of(route_));
    if (send_frames(door_, frames)) return true;
    frames.erase(frames.begin());
    return false;
}

std::optional<Frames> JoinedLine::receive() {
    if (arrived_.empty()) return std::nullopt;
    auto frames = std::move(arrived_.front());
    arrived_.pop_front();
    return frames;
}

void JoinedLine::renew() { arrived_.clear(); }

void JoinedLine::use(std::string route) {
    route_ = std::move(route);
    arrived_.clear();
}

void JoinedLine::arrived(Frames frames) { arrived_.push_back(std::move(frames)); }

}  // namespace lightnet
