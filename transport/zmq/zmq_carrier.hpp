// The carrier of a place: inproc:// to places of the same process, tcp:// to those of other hosts.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "core/run/message/carrier.hpp"
#include "transport/lines/frame_queue.hpp"
#include "transport/lines/leadership.hpp"
#include "transport/lines/line_book.hpp"
#include "transport/places/place_transport.hpp"
#include "transport/zmq/socket.hpp"

namespace lightnet {

/// How the sockets of one run inside one process are called. `run` keeps runs apart.
std::string inproc_endpoint(std::uint64_t run, std::uint32_t place);

/// Within the process a message is handed over by pointer. To another host it goes as a packet: over a line of the
/// place's own, where the host is in the LineBook, else through the gateway that all places of the process share. A
/// packet is kept until its reply is there, and sent again whenever a connection was cut. Belongs to one thread.
class ZmqCarrier final : public Carrier {
public:
    /// Between this place and the thread that owns the sockets to other hosts.
    struct Queues {
        std::shared_ptr<FrameQueue> asks, replies;
        std::shared_ptr<Leadership> door{};  // null: places never read it
        bool may_lead = false;               // what comes by the door may be for this place itself

        void put_reply(Frames& frames) const;
        Leadership* led() const { return may_lead ? door.get() : nullptr; }
    };
    struct Address {
        std::uint64_t run = 0;
        std::string host;                      // of this process, as in PlaceAt
        std::optional<std::uint32_t> place{};  // whose messages arrive here; none: it only asks, as the master does
        Queues queues{};                       // null: nobody asks but places of this process
    };
    /// `at_fault` is told of hosts that failed. `lines`: hosts that may be called from here; null: none.
    ZmqCarrier(
        const SocketContext& context, Address me, PlaceTransport::AtFault at_fault = [](const Failure&) {},
        std::shared_ptr<const LineBook> lines = nullptr);
    ~ZmqCarrier() override;

    bool ask(const PlaceAt& to, Message& message) override;
    void reply(Message message) override;
    std::optional<Message> receive() override;
    void wait(std::chrono::nanoseconds most) override;
    void give_up(std::uint32_t channel) override;
    bool take_out(const std::string& host, const std::string& why) override;
    void doubt(const Failure& lie) override;
    void forget(const PlaceAt& place) override;
    const Counters& counters() const override;

private:
    struct Sockets;
    std::unique_ptr<Sockets> sockets_;
};

}  // namespace lightnet
