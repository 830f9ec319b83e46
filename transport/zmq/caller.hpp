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
#include "transport/zmq/handshake.hpp"
#include "transport/zmq/poll.hpp"
#include "transport/zmq/socket.hpp"

namespace lightnet {

/// A socket that asks (asking_socket()) under an endpoint that may hold a name: all addresses of the name are called in
/// turn until one answers, and where none does, the name is looked up anew. Never waits. One thread's.
class Caller {
public:
    using Time = std::chrono::steady_clock::time_point;
    enum class Handshakes { noted, ignored };
    /// Without `keys` nothing is encrypted. Throws SocketError for what is no endpoint, or when there are no sockets.
    Caller(const SocketContext& context, std::string endpoint, std::optional<LineKeys> keys,
           Handshakes handshakes = Handshakes::ignored);

    /// Where it is, as others say: tried, too, after what is known here.
    void hear(std::vector<IpAddress> addresses) { heard_ = std::move(addresses); }
    /// Calls another address when it is time to. To be called several times a second.
    void tick(Time now);
    bool send(Frames& frames) { return socket_ && socket_->send(frames); }
    std::optional<Frames> receive() { return socket_ ? socket_->receive() : std::nullopt; }
    /// Somebody has answered, and has room for more.
    bool can_send() const { return socket_ && socket_->can_send(); }
    void watch(Poll& poll) const;
    /// What became of its handshakes, the last one since the last call; none: there was none.
    std::optional<Handshake> look_at_handshake();
    /// Where it answers, in numbers; "": the endpoint is a name, and nobody has answered so far.
    std::string answering_at() const;
    /// Why nobody answers, as far as the name has to do with it; "": it hasn't.
    std::string trouble() const;

private:
    void call(const IpAddress& address);
    int events_to_note() const;
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
    std::optional<Handshake> handshake_;
    Time next_look_{};
};

}  // namespace lightnet
