// Measures what goes over the edges of a graph at one place.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "core/network/graph/layout.hpp"
#include "core/run/assembly/gauge.hpp"
#include "core/run/assembly/place_tracer.hpp"
#include "core/run/message/place_record.hpp"

namespace lightnet {

/// Keeps figures of every Edge, and says along which is being asked (Gauge::along). Two looks at the clock for each
/// ask, however many questions it has. One thread's; outlives the assembly whose edges it measures.
class EdgeMeter {
public:
    /// How long the current work has run, not waited.
    using Running = std::function<std::chrono::nanoseconds()>;

    /// What is asked along the edges, the gauge's in their order, is shown by it as well.
    EdgeMeter(Gauge& gauge, std::vector<AskingEdge> shown, Running running);
    EdgeMeter(const EdgeMeter&) = delete;
    EdgeMeter& operator=(const EdgeMeter&) = delete;

    /// An edge, and where it is counted while others look: by the gauge, or, where that doesn't show it, here.
    struct Measured {
        EdgeRecord record;
        Gauge::Edge* shown = nullptr;
        Gauge::Edge own;
    };
    /// The edge between these nodes; it stays where it is.
    Measured& measured(std::size_t asker, std::size_t asked);

    /// An ask along an edge while it begins. Nodes that are called meanwhile ask along edges of their own.
    class Asking {
    public:
        Asking(EdgeMeter& meter, Measured& edge, std::size_t questions);
        ~Asking() { meter_.gauge_.along = before_; }
        Asking(const Asking&) = delete;
        Asking& operator=(const Asking&) = delete;
        /// It has begun; `called`: and is answered.
        void begun(std::size_t asker, std::size_t asked, bool called);

    private:
        EdgeMeter& meter_;
        EdgeRecord& record_;
        Gauge::Edge* before_;
        std::size_t questions_;
        std::chrono::steady_clock::time_point called_at_{};
        std::chrono::nanoseconds ran_before_;
    };

    /// Is told of nodes that were called; null: nobody is.
    void trace(PlaceTracer* tracer) { tracer_ = tracer; }
    /// Is asked whether what goes on now is done by this node while it learns; empty: nothing is.
    using Learns = std::function<bool(std::size_t node)>;
    void tell_learning(Learns learns) { learns_ = std::move(learns); }
    /// Writes what was measured so far.
    void write(const Graph& graph, PlaceRecord& to) const;

private:
    Gauge& gauge_;
    std::vector<AskingEdge> shown_;
    Running running_;
    Learns learns_;
    PlaceTracer* tracer_ = nullptr;
    std::map<std::pair<std::size_t, std::size_t>, Measured> edges_;
};

}  // namespace lightnet
