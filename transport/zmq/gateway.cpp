#include "transport/zmq/gateway.hpp"

namespace lightnet {

std::string gateway_endpoint(std::uint64_t run) { return "inproc://run-" + std::to_string(run) + "/gateway"; }

Gateway::Gateway(const SocketContext& context, std::uint64_t run)
    : endpoint_(gateway_endpoint(run)), socket_(answering_socket(context)) {
    socket_.bind(endpoint_);
}

Gateway::~Gateway() { socket_.unbind(endpoint_); }

std::optional<Frames> Gateway::receive() {
    while (auto frames = socket_.receive()) {
        if (frames->size() != 4) continue;
        places_.insert(text_of(frames->front()));
        return frames;
    }
    return std::nullopt;
}

bool Gateway::forward(const std::string& place, Frames& frames) {
    frames.emplace(frames.begin(), place);
    return socket_.send(frames);
}

void Gateway::request_resend(const std::string& host) {
    for (const auto& place : places_) {
        Frames frames;
        frames.emplace_back(host);
        forward(place, frames);
    }
}

}  // namespace lightnet
