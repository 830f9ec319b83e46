// The record of one place in a run: per node and per edge of the graph.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lightnet {

/// From a node to one that it asks.
struct EdgeRecord {
    std::uint64_t asks = 0;       // calls of the asker that asked
    std::uint64_t questions = 0;  // in them
    std::uint64_t called_ns = 0;  // running, in a node of this place that was called, and those that it called
    std::uint64_t waited_ns = 0;  // for answers of other places; others may have run meanwhile
    std::uint64_t bundles = 0;    // with questions of this edge, that went to other places
    std::uint64_t sent = 0;       // questions that went so
    std::uint64_t bytes = 0;      // of them and of their answers, as they lie in memory
    std::uint64_t learning = 0;   // of `questions`: that the asker asked for shards of preparing, or in a rehearsal ...
    std::uint64_t learning_ns = 0;  // ... and of `called_ns`
    friend bool operator==(const EdgeRecord&, const EdgeRecord&) = default;
};

/// How much pieces of work differ in what they cost: how many there were, by the time that each took, in steps of a
/// quarter of an octave.
struct CostSpread {
    std::map<std::uint32_t, std::uint64_t> counts;  // by step: quarters of the logarithm of nanoseconds to base 2
    void add(double ns, std::uint64_t pieces) {
        if (pieces > 0) counts[static_cast<std::uint32_t>(std::lround(4 * std::log2(std::max(ns, 1.0))))] += pieces;
    }
    void add(const CostSpread& more) {
        for (const auto& [step, count] : more.counts) counts[step] += count;
    }
    static double ns_of(std::uint32_t step) { return std::exp2(0.25 * step); }
    friend bool operator==(const CostSpread&, const CostSpread&) = default;
};

struct NodeRecord {
    std::uint64_t answered = 0;    // work that other places, or the launcher, asked: questions, blocks of tiles, shards
    std::uint64_t busy_ns = 0;     // running for it, with the nodes that were called; all without what it waited for a
                                   // processor that others had
    std::uint64_t bundles = 0;     // that this place sent to others for this node
    std::uint64_t replies = 0;     // that were answered
    std::uint64_t latency_ns = 0;  // from sending to the answer, of all of them together
    std::uint64_t shards = 0;      // that its calls have, for all copies together
    std::uint64_t rounds = 0;      // its calls, for which all copies waited for each other
    std::uint64_t shard_ns = 0;    // of `busy_ns`: for those that this copy did, and for tiles of rehearsals
    std::uint64_t prepare_ns = 0;  // running in prepare(), beside the shards
    std::uint64_t prepared = 0;    // bytes of results that this copy was given
    CostSpread costs{};            // of questions, or of blocks of tiles, without those of rehearsals
    friend bool operator==(const NodeRecord&, const NodeRecord&) = default;
};

/// A value; travels as text. Times are nanoseconds.
struct PlaceRecord {
    std::string host;  // as in plans; "": the launcher's process
    std::uint32_t index = 0;
    std::uint64_t lived_ns = 0;   // serving
    std::uint64_t waited_ns = 0;  // of it: with work that waits for answers of others, and nothing else to do
    std::uint64_t idle_ns = 0;    // of it: with no work at all
    std::map<std::string, NodeRecord> nodes;
    std::map<std::pair<std::string, std::string>, EdgeRecord> edges;  // asker, asked
    friend bool operator==(const PlaceRecord&, const PlaceRecord&) = default;
};

/// Leaves `share` of all time that its nodes ran, and of what pieces of their work cost.
void keep_of_work(double share, PlaceRecord& record);

std::string to_text(const std::vector<PlaceRecord>& records);
/// Reads it back. Throws Error on anything else.
std::vector<PlaceRecord> place_records_from(std::string_view text);

}  // namespace lightnet
