// Figures of the places of a host, for those who watch a run.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lightnet {

/// How often, when a place was looked at, it worked on a node, on its own messages, waited for answers, or had nothing
/// to do.
struct PlaceFigures {
    std::uint64_t busy = 0, asking = 0, waiting = 0, idle = 0;
    friend bool operator==(const PlaceFigures&, const PlaceFigures&) = default;
};

/// Of one node, over all places of a host.
struct NodeFigures {
    std::uint64_t looks = 0;    // at places that worked on it, and on nobody whom it called
    std::uint64_t waiting = 0;  // questions now
    // What places of this host sent to it elsewhere.
    std::uint64_t bundles = 0, questions = 0;
    std::uint64_t bytes = 0;        // of questions and answers, as they lie in memory
    std::uint64_t nanoseconds = 0;  // from sending to the answer, over all bundles that are answered
    std::uint64_t answered = 0;     // bundles

    NodeFigures& operator+=(const NodeFigures& more);
    friend bool operator==(const NodeFigures&, const NodeFigures&) = default;
};

/// Of one edge, over all places of a host.
struct EdgeFigures {
    std::uint64_t questions = 0;  // asked along it, called or sent
    std::uint64_t bundles =
        0;                    // with questions of this edge, that went to other places; those of others may be in them
    std::uint64_t sent = 0;   // questions that went so
    std::uint64_t bytes = 0;  // of them and of their answers, as they lie in memory

    EdgeFigures& operator+=(const EdgeFigures& more);
    friend bool operator==(const EdgeFigures&, const EdgeFigures&) = default;
};

/// A value. Counts only grow, but for what waits.
struct HostFigures {
    std::vector<PlaceFigures> places;  // by index
    std::vector<NodeFigures> nodes;    // as in the graph
    std::vector<EdgeFigures> edges;    // see asking_edges()
    std::uint64_t clock_ns = 0;        // of the host, when it said so
    std::uint64_t processor_ns = 0;    // that its process has had by then, all threads together
    friend bool operator==(const HostFigures&, const HostFigures&) = default;
};

/// As they ride on heartbeats, and back. None: damaged, or larger than any host's.
std::string to_text(const HostFigures& figures);
std::optional<HostFigures> figures_from(std::string_view text);

}  // namespace lightnet
