// The ways from a place to the nodes that its own nodes ask: in itself, at other places, or at both.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "core/run/assembly/assembly.hpp"
#include "core/run/assembly/gauge.hpp"
#include "core/run/fiber/fiber.hpp"
#include "core/run/message/carrier.hpp"
#include "core/run/message/tuning.hpp"
#include "core/run/place/bundle_port.hpp"
#include "core/run/place/own_time.hpp"
#include "core/run/schedule/remote_channels.hpp"
#include "core/run/schedule/routing_port.hpp"

namespace lightnet {

/// Ports by node and width, made when they are first asked for, and led anew with each plan. Where others have less to
/// do than this place, they get some of what its own nodes ask each other. One place's.
class PlacePorts {
public:
    using Clock = std::chrono::steady_clock;

    /// The place that they belong to, and what it lends them. Outlives them.
    struct Lent {
        const Network& network;
        const PlaceAt& me;
        std::uint64_t run;
        const Tuning& tuning;
        Carrier& carrier;
        Gauge& gauge;
        Counters& counters;
        Fibers& fibers;
        std::function<void(Fibers::Fiber*)> wake;
        std::function<Assembly&()> assembly;  // not made yet when they are
        std::function<void()> pause;          // called at every ask of a node of this place
        /// Told how long an answer took to what helpers have left.
        std::function<void(std::size_t node, std::chrono::nanoseconds)> answered_own;
        OwnTime& own_time;  // is told of each sleep
    };
    PlacePorts(Lent lent, const Plan& plan);

    Port* port_to(std::size_t node, std::size_t width);
    /// Who holds what, from now on.
    void use(const Plan& plan);
    /// Answers have come.
    void arrived(Message& message) { channels_.arrived(message); }
    /// Sends what is due; `idle`: or would be. False: nothing was sent.
    bool flush(bool idle);
    /// The place has nothing to do: until a message has come, or something is due.
    void wait();
    /// Begins to answer some of what waits for helpers. False: nothing does.
    bool start_own();

private:
    using Key = std::pair<std::size_t, std::size_t>;  // node and width

    // The port to a node of other places, and its channels to each of them.
    struct Remote {
        std::unique_ptr<BundlePort> port;
        RemoteChannels<Query>::Edge edge;
        // Where others answer for this place:
        double own_seconds = 0;      // that one of its questions takes here; 0: not known
        std::size_t own_fibers = 0;  // that answer them here now
        Clock::time_point faded{};   // when helpers were last thought to be quicker than they were
    };

    // A port to a node of this place whose questions others could answer, too.
    struct Relieved {
        Key key;
        RoutingPort* port;
        std::size_t helpers;
        bool asks_on;  // the node
    };

    Port* port_to_one(Key key);
    Port* port_to_sectors(Key key);
    Port* bundle_port_to(Key key);
    MultiplexerRules multiplexer_rules(std::size_t node);
    bool called_here(std::size_t node) const;
    std::size_t helpers_of(std::size_t node) const;
    Plan plan_for(std::size_t node) const;
    void lead(Key key, RoutingPort& port);
    void share_out(Clock::time_point now);
    void answer_own(const Relieved& relieved, const Bundle<Query>& bundle);

    Lent at_;
    Plan plan_;
    std::map<Key, std::unique_ptr<RoutingPort>> ports_;
    std::vector<Relieved> relieved_;
    std::vector<std::unique_ptr<Port>> within_;  // to nodes of this place, and to several sectors
    std::map<Key, Remote> remotes_;
    RemoteChannels<Query> channels_;
};

}  // namespace lightnet
