// ZeroMQ between the places of a process.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "transport/places/place_transport.hpp"
#include "transport/zmq/poll.hpp"
#include "transport/zmq/socket.hpp"

namespace lightnet {

/// Between places messages go by pointer, over inproc://. To places go also packets of other hosts, untouched: for the
/// thread that owns the sockets to those.
class ZmqPlaceTransport final : public PlaceTransport {
public:
    /// For `places` places of `host`. Throws Error when there are too few descriptors for so many.
    ZmqPlaceTransport(std::shared_ptr<const SocketContext> context, std::uint64_t run, std::string host,
                      std::uint32_t places);

    std::unique_ptr<Carrier> carrier_of(std::uint32_t place, AtFault at_fault) override;
    std::unique_ptr<Carrier> asking_carrier() override;
    void tell(std::uint32_t place, Message message) override;

    /// Frames for a place that serves, or for the dispatcher (any_place); replies to it come back by receive().
    /// False: there is no such place, or it has ended.
    bool forward(std::uint32_t place, Frames& frames);
    /// What came from one line, of so many: one per place, in their order, and the dispatcher's.
    std::optional<Frames> receive(std::size_t line);
    std::size_t lines() const { return to_.size(); }
    /// All lines, in their order.
    void watch(Poll& poll);

private:
    std::size_t line_to(std::uint32_t place) const;
    Socket& socket_of(std::size_t line);

    std::shared_ptr<const SocketContext> context_;
    std::uint64_t run_;
    std::string host_;
    std::vector<std::optional<Socket>> to_;  // by line
};

/// For a run that stays within this process: see MakePlaceTransport.
std::unique_ptr<PlaceTransport> zmq_within_process(std::uint64_t run, std::uint32_t places);

}  // namespace lightnet
