// The seam between hosts and what carries messages between them. Another transport is a folder beside zmq/, and a line
// where a launcher or a daemon begins (see zmq_hosts()).
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/ip_address.hpp"
#include "transport/keys/key.hpp"
#include "transport/lines/message_frame.hpp"
#include "transport/lines/poll.hpp"

namespace lightnet {

/// What became of a message.
enum class SendResult { sent, line_is_full, peer_is_gone };

/// How a handshake ended.
enum class Handshake {
    made,        // they know each other
    refused,     // the other end doesn't take our key
    mismatched,  // one end speaks with keys, the other without; after this and after `refused` no more is tried
    abandoned,   // by the other end, which may be mismatched, have another key, or be cut off
    unanswered   // the other end was reached, and said nothing in time: it is stopped, cut off, or has too much to do
};
/// Does anybody want to know?
enum class Handshakes { noted, ignored };

/// Whom a port lets in.
struct DoorKeys {
    KeyPair own;  // of the port
    std::function<bool(const PublicKey&)> knows;
    std::function<void(const PublicKey&, const std::string& address)> turned_away = [](auto&, auto&) {};
    /// Somebody without a key, or who takes the port for another one.
    std::function<void()> no_key = [] {};
};

/// A line that this process opened to another one, wherever that is: it goes on calling until somebody answers. Never
/// waits. The other end greets each connection with an empty message. One thread's.
class HostLine {
public:
    using Time = std::chrono::steady_clock::time_point;

    virtual ~HostLine() = default;
    /// Where the other end is, as others say: tried, too, after what is known here.
    virtual void hear(std::vector<IpAddress>) {}
    /// Does what is due. To be called several times a second.
    virtual void tick(Time) {}
    /// False: it can't be sent now, and is as it was.
    virtual bool send(Frames& frames) = 0;
    virtual std::optional<Frames> receive() = 0;
    /// Somebody has answered, and has room for more.
    virtual bool can_send() const = 0;
    virtual void watch(Poll& poll) const = 0;
    /// What became of its handshakes, the last one since the last call; none: there was none.
    virtual std::optional<Handshake> look_at_handshake() { return std::nullopt; }
    /// Where it answers, by an endpoint that means nobody else; "": nowhere, so far.
    virtual std::string answering_at() const = 0;
    /// Places may call it there by themselves, see LineBook.
    virtual bool is_open_to_places() const { return false; }
    /// Why nobody answers, as far as that is known here; "": it isn't.
    virtual std::string trouble() const { return {}; }
};

/// A port at which others come in. Messages have the route to who sent them in front. One thread's.
class HostPort {
public:
    virtual ~HostPort() = default;
    /// Where it listens, with the port that the system chose.
    virtual std::string endpoint() const = 0;
    virtual std::optional<Frames> receive() = 0;
    /// The public key, as text, of whom the last message came from; empty: it came without.
    virtual std::string key() const { return {}; }
    /// The network address that it came from; empty: not from a network.
    virtual std::string address() const { return {}; }
    virtual SendResult send(Frames& frames) = 0;
    /// Lets in who waits, as far as there is room. To be called as often as receive().
    virtual void let_in() {}
    /// For messages.
    virtual void watch(Poll& poll) const = 0;
    /// For those who want to be let in.
    virtual void watch_callers(Poll&) const {}
};

/// Carries messages between the hosts of a run. Outlives its lines and ports.
class HostTransport {
public:
    virtual ~HostTransport() = default;
    /// Without `keys` nothing is encrypted, and nobody knows who the other is. Throws LineError for what is no
    /// endpoint, or when the system gives no line.
    virtual std::unique_ptr<HostLine> connect(const std::string& endpoint, const std::optional<LineKeys>& keys,
                                              Handshakes handshakes = Handshakes::ignored) = 0;
    /// Without `keys` it lets in everybody, as long as there is room. Throws Error when the port can't be had.
    virtual std::unique_ptr<HostPort> listen(const std::string& endpoint, std::optional<DoorKeys> keys) = 0;
};

}  // namespace lightnet
