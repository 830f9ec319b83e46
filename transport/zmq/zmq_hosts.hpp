// Hosts that talk by ZeroMQ.
#pragma once

#include <memory>

#include "transport/lines/host_transport.hpp"
#include "transport/zmq/socket.hpp"

namespace lightnet {

/// `context`: of all its sockets.
std::shared_ptr<HostTransport> zmq_hosts(
    std::shared_ptr<const SocketContext> context = std::make_shared<const SocketContext>());

}  // namespace lightnet
