// A place: one thread that owns its nodes, its fibers and its sockets.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/run/assembly/assembly.hpp"
#include "core/run/assembly/direct_port.hpp"
#include "core/run/assembly/edge_meter.hpp"
#include "core/run/assembly/gauge.hpp"
#include "core/run/assembly/place_tracer.hpp"
#include "core/run/fiber/fiber.hpp"
#include "core/run/fiber/rounds.hpp"
#include "core/run/message/asks_in_hand.hpp"
#include "core/run/message/carrier.hpp"
#include "core/run/message/tuning.hpp"
#include "core/run/place/bundle_port.hpp"
#include "core/run/place/place_locks.hpp"
#include "core/run/place/preparer.hpp"
#include "core/run/schedule/remote_channels.hpp"
#include "core/run/schedule/routing_port.hpp"
#include "core/run/schedule/sector_port.hpp"

namespace lightnet {

/// Answers for its nodes until it is told to stop. Nothing is shared between places but the network, which is constant.
/// What it is at can be read off its gauge, which outlives it.
///
/// No graph can make places wait for each other for ever: a bundle whose node has no fiber running is always given
/// one, bundles of the lowest rank (the longest way down to a node that asks nobody) go first, and the asker has kept
/// room for the reply. A node that works on its questions concurrently needs no other fiber than that one to go on;
/// see Rounds. So the nodes that ask nobody always finish, then those that ask only them, and so on.
class Place {
public:
    Place(const Network& network, const PlaceAt& me, const Plan& plan, std::uint64_t run, const Tuning& tuning,
          Carrier& carrier, Gauge& gauge);
    ~Place();
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;

    /// Tells `tracer` from now on what it is busy with.
    void trace(PlaceTracer& tracer);
    /// Serves until a stop message arrives or `stop` is set. Once, on the thread that made the place. Counts the
    /// bundles and tiles that it answers in `progress`: a sign of life for other threads.
    void serve(const std::atomic<bool>& stop, std::atomic<std::uint64_t>& progress);
    Counters counters() const;

private:
    using Clock = std::chrono::steady_clock;
    struct Inbox {
        std::deque<Message> waiting;
        std::size_t questions = 0;  // in `waiting`, and in answering
        std::size_t answering = 0;  // that fibers answer now
        std::size_t fibers = 0;     // that answer for this node now
        double question_ns = 0;     // per question about light or block of a tile, smoothed
        double shard_ns = 0;        // per shard, smoothed: one may take as long as ten thousand questions
        NodeRecord figures;
    };

    // The port to a node of other places, and its channels to each of them.
    struct Remote {
        std::unique_ptr<BundlePort> port;
        RemoteChannels<Query>::Edge edge;
        // Where others answer for this place:
        double own_seconds = 0;      // that one of its questions takes here; 0: not known
        std::size_t own_fibers = 0;  // that answer them here now
    };

    // A port to a node of this place whose questions others could answer, too.
    struct Relieved {
        std::size_t node, width;
        RoutingPort* port;
        std::size_t helpers;
    };

    std::function<void(Fibers::Fiber*)> wake();
    std::function<void(Message)> reply();
    bool holds(std::size_t node) const;
    void assemble(std::size_t node);
    Port* port_to(std::size_t node, std::size_t width);
    Port* port_to_one(std::size_t node, std::size_t width);
    Port* port_to_sectors(std::size_t node, std::size_t width);
    bool called_here(std::size_t node) const;
    std::vector<std::uint32_t> helpers(std::size_t node) const;
    Plan plan_for(std::size_t node) const;
    void use(std::size_t node, std::size_t width, RoutingPort& port);
    void share_out();
    bool start_own();
    void answer_own(const Relieved& relieved, const Bundle<Query>& bundle);
    Port* direct_port_to(std::size_t node, std::size_t width);
    Port* bundle_port_to(std::size_t node, std::size_t width);
    void use(const Plan& plan);
    void cancel_asks_of_lost(const Plan& before);
    bool may_rehearse(std::size_t node) const;
    MultiplexerRules multiplexer_rules(std::size_t node);
    void take_in();
    void take(Message message);
    void queue(Message message);
    void work_once(Clock::time_point begun);
    bool step();
    bool start_next(bool images);
    bool may_start(std::size_t node) const;
    bool has_more(Role role) const;
    std::vector<Message> next_asks(std::size_t node);
    static bool is_learning(const Message& ask);
    static void note_cost(NodeRecord& figures, const Message& ask, std::uint64_t ns, std::size_t questions);
    void answer(std::vector<Message>& asks);
    bool answer_together(const std::vector<Message>& asks, std::vector<Message>& replies);
    void answer_alone(const Message& ask, Message& reply);
    std::vector<Rgb> light_answers(std::size_t node, std::size_t width, std::span<const Query> questions);
    std::vector<Rgb> pixel_answers(const Message& message, const Tile*& at);
    void pause();
    void look() const;
    bool flush(bool idle);
    std::chrono::nanoseconds patience() const;
    void wait();
    void tell_so_far(Clock::time_point begun);
    PlaceRecord record() const;
    Load load_of(std::size_t node, double service_ns) const;
    std::string my_name() const;
    Whereabouts whereabouts() const;

    const Network& network_;
    PlaceAt me_;
    Plan plan_;
    std::uint64_t run_;
    Tuning tuning_;
    Carrier& carrier_;
    Gauge& gauge_;
    Counters counters_;
    std::uint64_t rays_before_;
    const std::atomic<bool>* stop_ = nullptr;
    std::atomic<std::uint64_t>* progress_ = nullptr;
    bool stopping_ = false;

    Fibers fibers_;
    std::deque<Fibers::Fiber*> ready_;   // whose answers are there
    std::deque<Fibers::Fiber*> paused_;  // that made way for others
    Rounds rounds_;
    std::size_t spare_in_use_ = 0;
    Clock::time_point last_look_{};

    AsksInHand in_hand_;
    std::vector<Inbox> inboxes_;                                                         // by node
    std::vector<std::size_t> by_rank_;                                                   // nodes, lowest rank first
    std::map<std::pair<std::size_t, std::size_t>, std::unique_ptr<RoutingPort>> ports_;  // by node and width
    std::vector<Relieved> relieved_;
    std::vector<std::unique_ptr<DirectPort>> direct_ports_;
    std::vector<std::unique_ptr<SectorPort>> sector_ports_;
    std::map<std::pair<std::size_t, std::size_t>, Remote> remotes_;  // by node and width
    RemoteChannels<Query> channels_;
    PlaceLocks locks_;
    std::map<const Fibers::Fiber*, std::size_t> learning_;  // fibers that do shards, or rehearse: for which node
    EdgeMeter meter_;
    PlaceRecord record_;
    PlaceTracer* tracer_ = nullptr;
    Assembly assembly_;
    Preparer preparer_;
};

}  // namespace lightnet
