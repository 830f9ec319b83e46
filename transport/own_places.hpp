// Places of the launcher's own process in a run with other hosts.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "core/run/prepare/assembly.hpp"
#include "core/run/runtime/place.hpp"
#include "transport/sockets.hpp"

namespace lightnet {

/// They take part like a host, called "" in plans; what goes between them and other hosts goes over the lines that the
/// launcher has to each. One thread's.
class OwnPlaces {
public:
    struct Takers {
        std::function<void(Message)> work;      // a reply to the master
        std::function<void(Frames&)> asked;     // [place][host][header][body]: for another host
        std::function<void(Frames&)> answered;  // [address][header][body]: to another host
    };
    OwnPlaces(zmq::context_t& context, std::shared_ptr<const Network> network, std::uint64_t run, std::uint32_t count,
              const Plan& plan, Tuning rules);
    ~OwnPlaces();

    std::uint32_t count() const;
    /// True when they serve. Throws Error when one can't be assembled, or has died.
    bool ready();
    void use(const Plan& plan);
    void receive(const Takers& takers);
    /// From the master.
    bool ask(Message& message, std::uint32_t place);
    /// From another host: an ask, or a reply to a place.
    bool pass_ask(Frames& frames, std::uint32_t place);
    bool pass_reply(const std::string& place, Frames& frames);
    /// What was under way to this host may be lost; "": to any.
    void say_again(const std::string& host);
    /// Hosts that failed at what these places had asked them, since the last call.
    std::vector<Failure> failures();
    Counters stop();
    std::uint64_t progress() const;
    /// For polling.
    std::vector<zmq::socket_t*> sockets();
    int news() const;

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace lightnet
