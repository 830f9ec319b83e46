// The gauge of a place, for others to read while it works.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/network/graph/kind.hpp"
#include "core/network/graph/plan.hpp"

namespace lightnet {

/// Who asks whom.
struct AskingEdge {
    std::size_t from = 0, to = 0;  // nodes
    friend bool operator==(const AskingEdge&, const AskingEdge&) = default;
};
/// Of a checked graph: node by node, its inputs, and what the renderer shows beside them.
std::vector<AskingEdge> asking_edges(const Graph& graph, const Layers& layers, const Registry& registry);

/// Written by one thread, the place's, and read by any: each number for itself, none of them waits for another. Costs
/// the writer hardly more than ordinary variables.
class Gauge {
public:
    /// What a place is at: a node (from first_node on), or one of these.
    enum Doing : std::uint16_t { idle, waiting, asking, first_node };
    static Doing at(std::size_t node) { return static_cast<Doing>(first_node + node); }

    class Count {
    public:
        void add(std::uint64_t more) { set(get() + more); }
        void set(std::uint64_t value) { value_.store(value, std::memory_order_relaxed); }
        std::uint64_t get() const { return value_.load(std::memory_order_relaxed); }

    private:
        std::atomic<std::uint64_t> value_{0};
    };
    /// See NodeFigures.
    struct Node {
        Count waiting, bundles, questions, bytes, nanoseconds, answered;
    };
    /// See EdgeFigures.
    struct Edge {
        Count questions, bundles, sent, bytes;
    };

    Gauge(std::size_t node_count, std::size_t edge_count) : nodes(node_count), edges(edge_count) {}

    /// Returns what it was at.
    Doing set_activity(Doing doing) {
        const Doing before = this->doing();
        doing_.store(doing, std::memory_order_relaxed);
        return before;
    }
    Doing doing() const { return static_cast<Doing>(doing_.load(std::memory_order_relaxed)); }
    /// For Fibers::show().
    std::atomic<std::uint16_t>& shown() { return doing_; }

    Count pulse;  // grows while the place works, and stands still while it waits or hangs
    std::vector<Node> nodes;
    std::vector<Edge> edges;  // by asking_edges()
    /// As in Counters and PlaceRecord, so far.
    Count rays, lived_ns, waited_ns, idle_ns;
    Edge* along = nullptr;  // the place's own: along which it begins to ask just now; null: nobody counts it

private:
    std::atomic<std::uint16_t> doing_{idle};
};

/// Until the end of a block, a place is at something else.
class ScopedActivity {
public:
    ScopedActivity(Gauge& gauge, Gauge::Doing doing) : gauge_(gauge), before_(gauge.set_activity(doing)) {}
    ~ScopedActivity() { gauge_.set_activity(before_); }
    ScopedActivity(const ScopedActivity&) = delete;
    ScopedActivity& operator=(const ScopedActivity&) = delete;

private:
    Gauge& gauge_;
    Gauge::Doing before_;
};

}  // namespace lightnet
