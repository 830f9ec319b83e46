#include "transport/relay_door.hpp"

#include <zmq.hpp>

#include "transport/relay.hpp"

namespace lightnet {

RelayDoor::RelayDoor(zmq::context_t& context, std::uint64_t run)
    : endpoint_(relay_endpoint(run)), socket_(std::make_unique<zmq::socket_t>(answering_socket(context))) {
    socket_->bind(endpoint_);
}

RelayDoor::~RelayDoor() {
    try {
        socket_->unbind(endpoint_);  // closing alone frees the name later
    } catch (const zmq::error_t&) {
    }
}

std::optional<Frames> RelayDoor::receive() {
    while (auto frames = receive_frames(*socket_)) {
        if (frames->size() != 4) continue;
        places_.insert(text_of(frames->front()));
        return frames;
    }
    return std::nullopt;
}

bool RelayDoor::pass(const std::string& place, Frames& frames) {
    frames.insert(frames.begin(), frame_of(place));
    return send_frames(*socket_, frames);
}

void RelayDoor::say_again() {
    for (const auto& place : places_) {
        auto frames = empty_message();
        pass(place, frames);
    }
}

}  // namespace lightnet
