#include "transport/zmq/gateway.hpp"

#include <zmq.hpp>

namespace lightnet {

std::string way_out_endpoint(std::uint64_t run) { return "inproc://run-" + std::to_string(run) + "/way-out"; }

WayOut::WayOut(zmq::context_t& context, std::uint64_t run)
    : endpoint_(way_out_endpoint(run)), socket_(std::make_unique<zmq::socket_t>(answering_socket(context))) {
    socket_->bind(endpoint_);
}

WayOut::~WayOut() {
    try {
        socket_->unbind(endpoint_);  // closing alone frees the name later
    } catch (const zmq::error_t&) {
    }
}

std::optional<Frames> WayOut::receive() {
    while (auto frames = receive_frames(*socket_)) {
        if (frames->size() != 4) continue;
        places_.insert(text_of(frames->front()));
        return frames;
    }
    return std::nullopt;
}

bool WayOut::pass(const std::string& place, Frames& frames) {
    frames.insert(frames.begin(), frame_of(place));
    return send_frames(*socket_, frames);
}

void WayOut::say_again(const std::string& host) {
    for (const auto& place : places_) {
        Frames frames;
        frames.push_back(frame_of(host));
        pass(place, frames);
    }
}

}  // namespace lightnet
