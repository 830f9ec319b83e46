#include "transport/host_line.hpp"

#include <utility>
#include <zmq.hpp>

namespace lightnet {

CalledLine::CalledLine(zmq::context_t& context, std::string endpoint)
    : context_(context), endpoint_(std::move(endpoint)) {
    renew();
}

CalledLine::~CalledLine() = default;

bool CalledLine::send(Frames& frames, bool files) {
    return send_frames(files ? *files_.socket : *work_.socket, frames);
}

std::optional<Frames> CalledLine::Lane::receive() {
    auto frames = receive_frames(*socket);
    if (frames && is_empty(*frames) && !std::exchange(greeted, true)) return receive();
    return frames;
}

std::optional<Frames> CalledLine::receive() {
    auto frames = work_.receive();
    return frames ? std::move(frames) : files_.receive();
}

void CalledLine::renew() {
    for (auto* lane : {&work_, &files_})
        *lane = Lane{std::make_unique<zmq::socket_t>(asking_socket(context_, endpoint_)), false};
}

std::vector<zmq::socket_t*> CalledLine::sockets() { return {work_.socket.get(), files_.socket.get()}; }

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
