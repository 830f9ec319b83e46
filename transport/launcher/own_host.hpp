// Places of the launcher's own process in a run with other hosts.
#pragma once

#include <cstdint>
#include <memory>

#include "core/base/own_process.hpp"
#include "core/run/assembly/assembly.hpp"
#include "core/run/place/place.hpp"
#include "transport/launcher/host_link.hpp"
#include "transport/places/place_threads.hpp"
#include "transport/zmq/gateway.hpp"
#include "transport/zmq/zmq_place_transport.hpp"

namespace lightnet {

/// They take part like a host, called "" in plans; what goes between them and other hosts goes over the connections
/// that the launcher has to each. They can't be lost, and end with the run.
class OwnHost final : public HostLink {
public:
    /// `plan`: that they assemble themselves by. Throws Error when there is no room for so many places.
    OwnHost(const std::shared_ptr<const SocketContext>& context, std::shared_ptr<const Network> network,
            std::uint64_t run, std::uint32_t places, const Plan& plan, Tuning rules);

    std::string title() const override { return "this process"; }
    std::string ready_words() const override { return "places of this process are ready"; }
    std::uint64_t peak_memory() const override { return lightnet::peak_memory(); }
    std::uint64_t progress() const override { return threads_.progress(); }
    std::uint64_t pulse() const override { return threads_.pulse(); }
    Doings doing() const override { return threads_.doing(); }
    void watch_places() override;
    HostFigures figures() const override { return threads_.figures(); }
    void watch(Poll& poll) override;
    void tick(Time, const ExpectedPlan&) override {}
    bool receive(Time now, const Handlers& handlers) override;
    bool send(Message& message, std::uint32_t place) override;
    bool forward_ask(Frames& frames, std::uint32_t place) override;
    bool forward_reply(const RelayAddress& asker, Frames& frames) override;
    void request_resend() override { gateway_.request_resend(""); }
    void use(const WrittenPlan& plan) override;
    bool bring(const Hash&, const Bytes&) override { return true; }  // by pointer
    bool take_out(const std::string&) override { return false; }
    bool drain() override { return false; }
    void lose(Time, const std::string&) override {}
    void send_end() override;
    Counters wait_for_end() override { return threads_.stop(); }

private:
    void relay_ask(Frames& frames, const Handlers& handlers);

    Gateway gateway_;
    ZmqPlaceTransport transport_;
    PlaceThreads threads_;
    bool ending_ = false;
};

}  // namespace lightnet
