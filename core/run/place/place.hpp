// A place: one thread that owns its nodes, its fibers and its sockets.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/run/assembly/assembly.hpp"
#include "core/run/assembly/edge_meter.hpp"
#include "core/run/assembly/gauge.hpp"
#include "core/run/assembly/place_tracer.hpp"
#include "core/run/fiber/fiber.hpp"
#include "core/run/fiber/rounds.hpp"
#include "core/run/message/carrier.hpp"
#include "core/run/message/tuning.hpp"
#include "core/run/place/answerer.hpp"
#include "core/run/place/own_time.hpp"
#include "core/run/place/place_inbox.hpp"
#include "core/run/place/place_locks.hpp"
#include "core/run/place/place_ports.hpp"
#include "core/run/place/preparer.hpp"

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
    /// By what others are asked: the plan that the place makes its nodes by, or nothing before it is told of one that
    /// is in force. The first may name places that are not prepared.
    enum class Asks { by_plan, when_told };
    Place(const Network& network, const PlaceAt& me, const Plan& plan, std::uint64_t run, const Tuning& tuning,
          Carrier& carrier, Gauge& gauge, Asks asks = Asks::by_plan);
    ~Place();
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;

    /// Tells `tracer` from now on what it is busy with.
    void trace(PlaceTracer& tracer);
    /// Serves until a stop message arrives or `stop` is set. Once, on the thread that made the place. Counts the
    /// bundles and tiles that it answers in `progress`: a sign of life for other threads.
    void serve(const std::atomic<bool>& stop, std::atomic<std::uint64_t>& progress);
    /// Serving in turns, for who has several places in one thread: after begin(), each turn does what is to be done for
    /// a moment, and waits at its carrier where that is nothing.
    void begin(const std::atomic<bool>& stop, std::atomic<std::uint64_t>& progress);
    void work_once();
    Counters counters() const;

private:
    using Clock = std::chrono::steady_clock;
    std::function<void(Fibers::Fiber*)> wake();
    std::function<void(Message)> reply();
    void assemble(std::size_t node);
    void use(const Plan& plan);
    void take_in();
    void take(Message message);
    bool step();
    bool start_next(bool images);
    void answer(std::vector<Message>& asks);
    void pause();
    void look() const;
    void wait();
    void tell_so_far();
    PlaceRecord record() const;
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
    struct Service {
        const std::atomic<bool>* stop = nullptr;
        std::atomic<std::uint64_t>* progress = nullptr;
        Clock::time_point begun{};
        bool stopping = false;
        OwnTime own_time{};
    } service_;

    Fibers fibers_;
    std::deque<Fibers::Fiber*> ready_;   // whose answers are there
    std::deque<Fibers::Fiber*> paused_;  // that made way for others
    Rounds rounds_;
    Clock::time_point last_look_{};

    PlaceInbox inbox_;
    PlacePorts ports_;
    PlaceLocks locks_;
    std::map<const Fibers::Fiber*, std::size_t> learning_;  // fibers that do shards, or rehearse: for which node
    EdgeMeter meter_;
    PlaceRecord record_;
    PlaceTracer* tracer_ = nullptr;
    Assembly assembly_;
    Preparer preparer_;
    Answerer answerer_;
};

}  // namespace lightnet
