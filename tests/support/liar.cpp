#include "tests/support/liar.hpp"

#include <chrono>
#include <span>
#include <zmq.hpp>

namespace lightnet::test {
namespace {

std::span<const std::byte> view(const std::string& text) { return std::as_bytes(std::span(text)); }

}  // namespace

struct Liar::Door {
    zmq::context_t context{1};
    zmq::socket_t socket{context, zmq::socket_type::router};
};

Liar::Liar(Answer answer) : door_(std::make_shared<Door>()), answer_(std::move(answer)) {
    door_->socket.set(zmq::sockopt::linger, 0);
    door_->socket.set(zmq::sockopt::probe_router, true);
    door_->socket.bind("tcp://127.0.0.1:*");
    endpoint_ = door_->socket.get(zmq::sockopt::last_endpoint);
    thread_ = std::jthread([this](const std::stop_token& stop) { serve(stop); });
}

Liar::~Liar() {
    thread_.request_stop();
    thread_.join();
}

void Liar::serve(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
        zmq::pollitem_t item{door_->socket.handle(), 0, ZMQ_POLLIN, 0};
        if (zmq::poll(&item, 1, std::chrono::milliseconds(20)) == 0) continue;
        std::vector<std::string> frames;
        zmq::message_t frame;
        do {
            if (!door_->socket.recv(frame)) break;
            frames.push_back(frame.to_string());
        } while (frame.more());
        take(std::move(frames));
    }
}

void Liar::take(std::vector<std::string> frames) {
    if (frames.size() != 3) return;
    const auto header = packet::peek_header(view(frames[1]));
    if (!header) return;
    asked_ += packet::is_ask(header->type);
    for (const auto& packet : answer_(*header, view(frames[2]))) {
        door_->socket.send(zmq::const_buffer(frames[0].data(), frames[0].size()), zmq::send_flags::sndmore);
        door_->socket.send(zmq::const_buffer(packet.header.data(), packet.header.size()), zmq::send_flags::sndmore);
        door_->socket.send(zmq::const_buffer(packet.body.data(), packet.body.size()));
    }
}

std::vector<packet::Packet> Liar::green_light(const packet::Header& ask) {
    if (ask.type != packet::Type::ask_light) return {};
    Message reply;
    reply.type = Message::Type::reply;
    reply.run = ask.run, reply.bundle = ask.bundle, reply.channel = ask.channel, reply.node = ask.node;
    reply.width = ask.width;
    reply.answers.assign(std::size_t{ask.count} * ask.width, Rgb{0, 50, 0});
    return {packet::pack(reply, 0)};
}

}  // namespace lightnet::test
