// ZeroMQ between the places of a process.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "transport/lines/frame_queue.hpp"
#include "transport/lines/leadership.hpp"
#include "transport/lines/line_book.hpp"
#include "transport/places/place_transport.hpp"
#include "transport/zmq/socket.hpp"

namespace lightnet {

/// Ways of places to other hosts with no thread of this process between.
struct ShortWays {
    std::shared_ptr<const LineBook> lines{};  // to hosts that they may call by themselves; null: none
    std::shared_ptr<Leadership> door{};       // null: they never read it
};

/// Between places messages go by pointer, over inproc://. Between places and the thread that owns the sockets to other
/// hosts, packets go untouched through queues.
class ZmqPlaceTransport final : public PlaceTransport {
public:
    /// For `places` places of `host`. Throws Error when there are too few descriptors for so many.
    ZmqPlaceTransport(std::shared_ptr<const SocketContext> context, std::uint64_t run, std::string host,
                      std::uint32_t places, ShortWays ways = {});

    std::unique_ptr<Carrier> carrier_of(std::uint32_t place, AtFault at_fault) override;
    std::unique_ptr<Carrier> asking_carrier() override;
    void tell(std::uint32_t place, Message message) override;

    /// Frames for a place that serves, or for the dispatcher (any_place); replies to it come back by receive().
    /// False: there is no such place, or it has ended.
    bool forward(std::uint32_t place, Frames& frames);
    /// What came from any of them.
    std::optional<Frames> receive() { return replies_->pop(); }
    /// Where replies come from; see FrameQueue for how to wait for them.
    FrameQueue& replies() { return *replies_; }

private:
    FrameQueue* queue_to(std::uint32_t place);

    std::shared_ptr<const SocketContext> context_;
    std::uint64_t run_;
    std::string host_;
    ShortWays ways_;
    std::vector<std::shared_ptr<FrameQueue>> to_;  // by place, and to the dispatcher
    std::shared_ptr<FrameQueue> replies_ = std::make_shared<FrameQueue>();
};

/// For a run that stays within this process: see MakePlaceTransport.
std::unique_ptr<PlaceTransport> zmq_within_process(std::uint64_t run, std::uint32_t places);

}  // namespace lightnet
