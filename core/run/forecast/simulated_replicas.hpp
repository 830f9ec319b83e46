// A Scheduler on a simulated clock, and those whom it has asked.
#pragma once

#include <cstddef>
#include <functional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/run/forecast/event_queue.hpp"
#include "core/run/schedule/scheduler.hpp"

namespace lightnet {

/// How busy an answerer is, as replies say it.
struct SimulatedLoad {
    std::size_t fill = 0;  // questions that wait there
    double service = 0;    // seconds of one
};

/// Some questions to a node, or blocks of tiles to the renderer.
struct SimulatedAsk {
    std::size_t node = 0;
    double questions = 0;  // usual ones
    double times = 1;      // as long as usual, that they take
    std::function<void(const SimulatedLoad&)> answered;
};

/// Deals bundles to replicas by the real rules, as a Multiplexer does. Nothing is lost here, so nobody is overdue.
class SimulatedReplicas {
public:
    using Send = std::function<void(Scheduler::Replica, SimulatedAsk)>;
    SimulatedReplicas(EventQueue& events, Strategy strategy, Send send);
    SimulatedReplicas(const SimulatedReplicas&) = delete;
    SimulatedReplicas& operator=(const SimulatedReplicas&) = delete;

    /// A replica, by the next number.
    void join(Scheduler::Host host, std::uint32_t places, bool within_process);
    void add(SimulatedAsk ask);
    /// See Scheduler::Faded.
    void fade(double after) { tell(Scheduler::Faded{after}); }
    std::size_t size() const { return scheduler_.replicas().present(); }
    std::size_t places() const { return scheduler_.replicas().places(); }
    const Scheduler& scheduler() const { return scheduler_; }

private:
    void tell(const Scheduler::Event& event);
    void tick();
    void replied(Scheduler::CopyId copy, const SimulatedLoad& load);

    EventQueue& events_;
    Send send_;
    Scheduler scheduler_;
    std::vector<Scheduler::Action> actions_;
    std::unordered_map<Scheduler::WorkId, SimulatedAsk> asks_;
    Scheduler::WorkId next_ = 1;
    Scheduler::Replica joined_ = 0;
};

}  // namespace lightnet
