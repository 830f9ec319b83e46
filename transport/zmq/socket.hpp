// Sockets as this project uses them: with the options that make them safe, and nothing else of the library.
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "transport/address/resolver.hpp"
#include "transport/keys/key.hpp"
#include "transport/lines/high_water.hpp"
#include "transport/lines/host_transport.hpp"
#include "transport/lines/line_error.hpp"
#include "transport/lines/look_first.hpp"

namespace zmq {
class context_t;
class socket_t;
}  // namespace zmq

namespace lightnet {

class ListeningPort;

/// What the library refuses.
class SocketError : public LineError {
public:
    /// Of an error number of the library.
    explicit SocketError(int number);
};

/// What the sockets of a process belong to; outlives them. Any thread.
class SocketContext {
public:
    /// With room for as many sockets as the system has descriptors for. Throws Error when there are too few left for
    /// any work, or too few threads. `io_threads` 0: for sockets within the process only.
    /// `names`: who knows where hosts are.
    explicit SocketContext(int io_threads = 1, std::shared_ptr<const NameService> names = system_names());
    /// Waits until all its sockets are closed.
    ~SocketContext();
    SocketContext(const SocketContext&) = delete;
    SocketContext& operator=(const SocketContext&) = delete;
    zmq::context_t& library() const { return *context_; }
    Resolver& names() const { return *names_; }

private:
    std::unique_ptr<Resolver> names_;
    std::unique_ptr<zmq::context_t> context_;
    const AwakeThreads::Told awake_;  // the library's, of which nobody knows when they sleep
};

/// For the other end of a connection to say who it is.
inline constexpr std::chrono::milliseconds handshake_patience{4000};

/// What happened to a connection: a number of the library (ZMQ_EVENT_…) and a value.
struct SocketEvent {
    int number = 0, value = 0;
};

/// Whom a message came from.
struct PeerName {
    std::string key;      // public, as text; empty: it came without
    std::string address;  // of the network; empty: it came from none
};

/// Never blocks, never lingers. One thread's.
class Socket final : public Waitable {
public:
    /// `type` is the library's number. See the functions below. Throws SocketError.
    Socket(const SocketContext& context, int type);
    ~Socket() override;
    Socket(Socket&& other) noexcept;
    Socket& operator=(Socket&& other) noexcept;

    /// Both throw SocketError. Of tcp:// they take numbers only, as the library's one thread for all connections would
    /// wait for the name server; see listen() and Caller.
    void bind(const std::string& endpoint);
    void connect(const std::string& endpoint);
    /// Takes in callers at a port that listens already, and is this socket's from then on. Throws SocketError.
    void bind(ListeningPort port, const std::string& endpoint);
    /// The endpoint is free for others at once; closing alone frees it later.
    void unbind(const std::string& endpoint) noexcept;
    /// Where it is bound, with the port that the system chose.
    std::string endpoint() const;
    /// Sends all frames or none. False: the peer is gone or its queue is full.
    bool send(Frames& frames) { return try_send(frames) == SendResult::sent; }
    /// Sends all frames or none, and says why not.
    SendResult try_send(Frames& frames);
    /// One whole message, if there is one. `sender`: is told whom it came from; may be null.
    std::optional<Frames> receive(PeerName* sender = nullptr);
    bool readable() const override;
    bool quiet() const override { return quiet_; }
    int descriptor() const override;
    /// A peer is there, and has room for more.
    bool can_send() const;
    /// Encrypts what passes, and shows who we are, or asks who comes (CURVE, RFC 26). Before bind() and connect().
    void call_with(const LineKeys& keys);
    void answer_with(const KeyPair& own);
    /// Notes from now on what happens to its connections, events of these kinds. Before bind() and connect(). Throws
    /// SocketError.
    void note_events(const SocketContext& context, int kinds);
    /// The next that was noted, if there is one.
    std::optional<SocketEvent> next_event();
    /// Is readable when there is one; null: none are noted.
    const Socket* events() const { return events_.get(); }
    /// The library's own, for options.
    zmq::socket_t& library() const { return *socket_; }

private:
    int happenings() const;
    std::unique_ptr<zmq::socket_t> socket_;
    // Whatever is done with it, sending as well, the library may take note of what has come, and then its descriptor
    // tells nothing of that any more.
    mutable bool quiet_ = false;
    std::unique_ptr<Socket> events_;
};

/// A socket that binds and answers: knows its peers, refuses those that are gone.
Socket answering_socket(const SocketContext& context);
/// A socket that answers other hosts: greets each connection with an empty message, so that a peer whose connection was
/// cut knows that what was under way may be lost. Who does not answer its heartbeats is cut off.
Socket door_socket(const SocketContext& context);
/// Has a door listen at `endpoint`: an address, a name or a network card of this machine, and a port, which may be "*".
/// Where a name has several addresses, at all of them. Throws Error with what would be right.
void listen(Socket& door, const SocketContext& context, const std::string& endpoint);
/// A socket that connects and asks: one peer only, sends nothing before the peer is there, says hello by itself after
/// each reconnection. Without `keys` nothing is encrypted, and nobody knows who the other is.
Socket asking_socket(const SocketContext& context, const std::string& endpoint,
                     const std::optional<LineKeys>& keys = std::nullopt);
/// An asking_socket() that the caller connects, who may look after it before.
Socket unconnected_asking_socket(const SocketContext& context, const std::string& endpoint,
                                 const std::optional<LineKeys>& keys);

}  // namespace lightnet
