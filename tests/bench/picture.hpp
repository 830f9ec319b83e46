// The picture that benchmarks render.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/network/graph/kind.hpp"
#include "core/run/assembly/job.hpp"
#include "core/run/message/carrier.hpp"

namespace lightnet::bench {

/// The Cornell box of graphs/, ready to be rendered in any way. Its kinds outlive it.
struct Picture {
    Job job;
    std::map<std::string, Bytes> files;
    std::shared_ptr<const Network> network;
    std::size_t image = 0;
    std::vector<Tile> tiles;

    Picture(const Registry& registry, std::uint32_t size, std::uint32_t samples);
    /// Colours per pixel.
    std::size_t width() const { return network->width_of(image); }
    /// One of a single pixel, whose nodes are others. Its hosts read the scene of this one.
    Job of_nodes(const std::string& file, std::vector<Node> nodes) const;
};

/// All pixels of some tiles, tile by tile.
using Pixels = std::vector<std::vector<Rgb>>;

/// Every `step`-th tile, from the first-th on, by a SerialRun.
Pixels render_serially(const Picture& picture, std::size_t first, std::size_t step);

/// Two threads, each with a SerialRun and half of the tiles; seconds from the beginning until a thread has finished,
/// on average: nobody is made to wait for the other. `meanwhile` is called until both have.
double seconds_of_independent_halves(const Picture& picture, const std::function<void()>& meanwhile);

/// Seconds until a master has all tiles from the places of `plan`.
double seconds_of_master(const Picture& picture, std::uint64_t run, Carrier& carrier, const Plan& plan);

}  // namespace lightnet::bench
