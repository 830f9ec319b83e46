// Calls a host wherever it is.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/ip_address.hpp"
#include "transport/address/address_turns.hpp"
#include "transport/keys/key.hpp"
#include "transport/lines/poll.hpp"
#include "transport/zmq/handshake.hpp"
#include "transport/zmq/socket.hpp"

namespace lightnet {

/// A socket that asks (asking_socket()) under an endpoint that may hold a name: all addresses of the name are called in
/// turn until one answers, and where none does, the name is looked up anew. Never waits. One thread's.
class Caller final : public HostLine {
public:
    /// Without `keys` nothing is encrypted. Throws SocketError for what is no endpoint, or when there are no sockets.
    Caller(const SocketContext& context, std::string endpoint, std::optional<LineKeys> keys,
           Handshakes handshakes = Handshakes::ignored);

    void hear(std::vector<IpAddress> addresses) override { heard_ = std::move(addresses); }
    /// Calls another address when it is time to.
    void tick(Time now) override;
    bool send(Frames& frames) override { return socket_ && socket_->send(frames); }
    std::optional<Frames> receive() override { return socket_ ? socket_->receive() : std::nullopt; }
    bool can_send() const override { return socket_ && socket_->can_send(); }
    void watch(Poll& poll) const override;
    std::optional<Handshake> look_at_handshake() override;
    /// "": the endpoint is a name, and nobody has answered so far.
    std::string answering_at() const override;
    bool is_open_to_places() const override { return true; }
    /// As far as the name has to do with it.
    std::string trouble() const override;

private:
    void call(const IpAddress& address);
    void look_at_events(Time now);

    const SocketContext* context_;
    std::string endpoint_;
    TcpEndpoint parts_;
    std::optional<LineKeys> keys_;
    bool by_number_ = false, notes_handshakes_ = false;
    std::optional<Socket> socket_;  // none: no address is known, or the system has no socket to give
    std::optional<IpAddress> called_;
    AddressTurns turns_;
    Whereabout known_;
    std::vector<IpAddress> heard_;
    HandshakeWatch handshakes_;
    Time next_look_{};
};

}  // namespace lightnet
