// The gateway of a process: where its places hand in what is for other hosts, and get the replies.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>

#include "transport/lines/poll.hpp"
#include "transport/zmq/socket.hpp"

namespace lightnet {

/// Where the places of a run find the gateway of their process.
std::string gateway_endpoint(std::uint64_t run);

/// Open for one run. One thread's.
class Gateway {
public:
    Gateway(const SocketContext& context, std::uint64_t run);
    /// Free for the next at once.
    ~Gateway();
    Gateway(const Gateway&) = delete;
    Gateway& operator=(const Gateway&) = delete;

    /// [place][host][header][body]
    std::optional<Frames> receive();
    /// A reply; false: there is no such place.
    bool forward(const std::string& place, Frames& frames);
    /// Has all places send again what was under way to a host, as it may be lost; "": to any.
    void request_resend(const std::string& host);
    void watch(Poll& poll) const { poll.add(socket_); }

private:
    std::string endpoint_;
    Socket socket_;
    std::set<std::string> places_;  // that have asked
};

}  // namespace lightnet
