// Costs of a run, wherever it goes on: taken from one that was recorded.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace lightnet {

/// What a node takes that learns first. Seconds are those of a thread at speed 1.
struct PreparingCost {
    std::uint32_t shards = 0;  // pieces that all copies do together
    double shard_seconds = 0;  // all of them
    double own_seconds = 0;    // of each host that holds it, beside them; its places do it together
    double bytes = 0;          // of results, that each host is given
    std::uint32_t rounds = 0;  // in which the pieces are done: all copies wait for the end of each; 0: one
    bool rehearses = false;    // looks where the picture looks: all hosts wait for each other, and it grows with that
};

/// A node, and one question that it is asked; of the renderer: one block of samples of a usual tile.
struct NodeCost {
    std::string name;
    double seconds = 0;  // without those that it asks, at speed 1
    PreparingCost preparing{};
    double memory = 0;  // bytes that a host keeps for it
};

/// One question leads to others.
struct EdgeCost {
    std::size_t from = 0, to = 0;
    double questions = 0;  // that one of `from` asks, on average
    double bytes = 0;      // of a question and its answer
};

/// How much the pieces of a picture differ: so many (a weight) take so many times as long as usual.
struct CostShare {
    double times = 1, weight = 1;
};

/// As they lie in a message.
inline constexpr double bytes_of_colour = 12;

/// A picture that is to be made. Pixels; samples of each.
struct PictureCost {
    std::uint32_t width = 0, height = 0, samples = 1, tile = 32;
    std::uint32_t colours = 1;  // of each pixel, that a tile brings
    std::uint32_t frames = 1;   // one after the other, each with all that it takes to begin and to end it
};

/// A value. Nodes are those of the graph, by index.
struct RunCosts {
    std::vector<NodeCost> nodes;
    std::vector<EdgeCost> edges;
    std::vector<std::size_t> order;  // those that the picture needs, each behind those that it needs
    std::vector<std::pair<std::size_t, std::size_t>> beside;  // who takes whose frozen state, which has to be beside it
    std::size_t image = 0;                                    // the renderer
    std::vector<CostShare> spread;                            // of its blocks; empty: all are alike
    PictureCost picture;
    double load_seconds = 0, write_seconds = 0;  // of the launcher, for a frame
    double launcher_tile_seconds = 0;            // that the launcher's thread runs for a usual tile that has come
    double host_bytes = 0;                       // of files that a host is sent before it begins
};

/// A connection: how much passes in a second, each way, and how long a message is on its way.
struct LineCost {
    double bytes_per_second = 1.25e9;
    double seconds = 1e-4;
};

/// Who may take part.
struct ForecastHost {
    std::string name;
    std::uint32_t places = 1;
    double speed = 1;       // of each place, beside those of the recorded run
    double memory = 0;      // bytes that may be kept for nodes; 0: as much as it takes
    double processors = 0;  // that its places share, perhaps a part of one; 0: one for each
    LineCost line{};

    /// The part of a processor that each of so many places has which are at work.
    double part_of(std::uint32_t busy) const { return processors > 0 ? std::min(1.0, processors / busy) : 1; }
    /// Of so many of its places together, beside one at speed 1.
    double power_of(std::uint32_t busy) const { return busy * speed * part_of(std::max(busy, 1U)); }
    double power() const { return power_of(places); }
};

}  // namespace lightnet
