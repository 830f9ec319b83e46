// A peer that may say anything.
#pragma once

#include <cerrno>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <zmq.hpp>

#include "tests/support/slowdown.hpp"
#include "transport/keys/key.hpp"
#include "transport/wire/packet.hpp"

namespace lightnet::test {

/// Speaks to a daemon as a launcher would, or worse.
class Stranger {
public:
    explicit Stranger(const std::string& endpoint, int patience_ms = 5000,
                      const std::optional<LineKeys>& keys = std::nullopt)
        : socket_(context_, zmq::socket_type::dealer) {
        if (keys) {
            const auto text = [](const auto& bytes) { return std::string(bytes.begin(), bytes.end()); };
            socket_.set(zmq::sockopt::curve_publickey, text(keys->own.open.bytes));
            socket_.set(zmq::sockopt::curve_secretkey, text(keys->own.secret));
            socket_.set(zmq::sockopt::curve_serverkey, text(keys->theirs.bytes));
        }
        socket_.set(zmq::sockopt::linger, 0);
        socket_.set(zmq::sockopt::rcvtimeo, slowdown * patience_ms);
        socket_.connect(endpoint);
    }
    /// As an ask of another host, whose `address` it goes behind.
    void send_behind(const std::string& address, const packet::Packet& packet) {
        socket_.send(zmq::const_buffer(address.data(), address.size()), zmq::send_flags::sndmore);
        send(packet);
    }
    void send(const packet::Packet& packet) {
        socket_.send(zmq::const_buffer(packet.header.data(), packet.header.size()), zmq::send_flags::sndmore);
        socket_.send(zmq::const_buffer(packet.body.data(), packet.body.size()));
    }
    void send(const std::string& bytes) { socket_.send(zmq::const_buffer(bytes.data(), bytes.size())); }
    std::pair<packet::Type, packet::Fields> receive() {
        zmq::message_t header, body;
        do {  // connections are greeted with an empty message
            if (!came(header)) return {packet::Type::ping, {}};
        } while (header.size() == 0 && !header.more());
        if (!came(body)) return {packet::Type::ping, {}};
        while (body.more()) {  // behind an address
            header = std::move(body);
            if (!came(body)) return {packet::Type::ping, {}};
        }
        const auto view = [](const zmq::message_t& m) {
            return std::span(static_cast<const std::byte*>(m.data()), m.size());
        };
        const auto read = packet::read_header(view(header), view(body));
        const auto fields = packet::unpack_fields(view(body));
        run_ = read ? read->run : 0;
        return {read ? read->type : packet::Type::ping, fields ? *fields : packet::Fields{}};
    }

    /// The number of the run that the last packet received belongs to.
    std::uint64_t run() const { return run_; }

private:
    // False: nothing has come in time. A signal, as fuzzers' clocks send them, changes nothing.
    bool came(zmq::message_t& message) {
        while (true) try {
                return socket_.recv(message).has_value();
            } catch (const zmq::error_t& error) {
                if (error.num() != EINTR) throw;
            }
    }

    std::uint64_t run_ = 0;
    zmq::context_t context_;
    zmq::socket_t socket_;
};

}  // namespace lightnet::test
