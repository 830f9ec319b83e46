// A simulated thread that works: what it holds, whom it asks, and what it is busy with.
#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <memory>
#include <vector>

#include "core/run/forecast/place_work.hpp"
#include "core/run/forecast/shared_processors.hpp"
#include "core/run/forecast/simulated_port.hpp"

namespace lightnet {

/// Does one piece of work after the other in the order of a Place: questions of the lowest rank first, then what
/// others have left of its own, then tiles. Work that waits for answers of others stays, and lets other work go on.
class SimulatedPlace {
public:
    /// All of these outlive it. `processors`: of its host.
    SimulatedPlace(EventQueue& events, SharedProcessors& processors, const RunCosts& costs, const PlaceWork& kind);
    SimulatedPlace(const SimulatedPlace&) = delete;
    SimulatedPlace& operator=(const SimulatedPlace&) = delete;

    void take(SimulatedAsk ask);
    /// The way to a node that it asks; made by connect().
    SimulatedPort* port(std::size_t node);
    SimulatedPort& connect(std::size_t node, std::size_t helpers, Strategy strategy, SimulatedReplicas::Send send);
    const PlaceWork& kind() const { return kind_; }
    /// Seconds in which it worked at all, and on each node.
    double busy() const { return busy_seconds_; }
    const std::vector<double>& by_node() const { return by_node_; }

private:
    struct Inbox {
        std::deque<SimulatedAsk> waiting;
        double questions = 0;    // that are not answered
        std::size_t fibers = 0;  // that work, or wait for answers of others
    };
    void go_on();
    bool start_first(bool images);
    bool start_own();
    void start(SimulatedAsk ask, bool counted);
    void computed(const SimulatedAsk& ask, bool counted);
    void finish(const SimulatedAsk& ask, bool counted);
    void flush(bool idle);

    EventQueue& events_;
    SharedProcessors& processors_;
    const RunCosts& costs_;
    const PlaceWork& kind_;
    std::vector<std::size_t> by_rank_;
    std::vector<Inbox> inboxes_;
    std::map<std::size_t, std::unique_ptr<SimulatedPort>> ports_;
    std::size_t spare_in_use_ = 0;
    bool busy_ = false;
    double busy_seconds_ = 0;
    std::vector<double> by_node_;
};

}  // namespace lightnet
