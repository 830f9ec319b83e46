// Measures what goes over the edges of a graph at one place.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "core/run/assembly/assembly.hpp"
#include "core/run/assembly/gauge.hpp"
#include "core/run/assembly/place_tracer.hpp"
#include "core/run/message/place_record.hpp"

namespace lightnet {

/// Stands between nodes and those that they ask, and says along which edge is being asked (Gauge::along). Two looks at
/// the clock for each ask, however many questions it has. One thread's; outlives the assembly that has its tap.
class EdgeMeter {
public:
    /// How long the current work has run, not waited.
    using Running = std::function<std::chrono::nanoseconds()>;

    /// What is asked along the edges, the gauge's in their order, is shown by it as well.
    EdgeMeter(Gauge& gauge, std::vector<AskingEdge> shown, Running running);
    ~EdgeMeter();
    EdgeMeter(const EdgeMeter&) = delete;
    EdgeMeter& operator=(const EdgeMeter&) = delete;

    /// `behind`: another tap, between the meter and the asked node; may be empty.
    Assembly::Tap tap(Assembly::Tap behind = {});
    /// Is told of nodes that were called; null: nobody is.
    void trace(PlaceTracer* tracer) { tracer_ = tracer; }
    /// Is asked whether what goes on now is done by this node while it learns; empty: nothing is.
    using Learns = std::function<bool(std::size_t node)>;
    void tell_learning(Learns learns) { learns_ = std::move(learns); }
    /// Writes what was measured so far.
    void write(const Graph& graph, PlaceRecord& to) const;

private:
    class MeteredPort;

    /// An edge, and where it is counted while others look: by the gauge, or, where that doesn't show it, here.
    struct Measured {
        EdgeRecord record;
        Gauge::Edge* shown = nullptr;
        Gauge::Edge own;
    };
    Measured& measured(std::size_t asker, std::size_t asked);

    Gauge& gauge_;
    std::vector<AskingEdge> shown_;
    Running running_;
    Learns learns_;
    PlaceTracer* tracer_ = nullptr;
    std::map<std::pair<std::size_t, std::size_t>, Measured> edges_;
    std::vector<std::unique_ptr<Port>> ports_;
};

}  // namespace lightnet
