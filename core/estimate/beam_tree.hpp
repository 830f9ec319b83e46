// Photon beams, found by what they pass.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/math/box.hpp"
#include "core/estimate/nearest.hpp"
#include "core/estimate/photon_beam.hpp"
#include "core/scene/direct_light.hpp"

namespace lightnet {

// DECISIONS: points-ask-beams
/// A binary tree of bounding boxes. Immutable; any thread may ask. What it answers depends on the beams alone.
class BeamTree {
public:
    explicit BeamTree(std::vector<PhotonBeam> beams);

    /// Radiance of each group of lamps that a collision there sends on: the density of the `most` nearest beams that
    /// pass within `radius` (m), across each of them, under Epanechnikov's kernel 2 (1 - d²/r²) / (π r²), whose radius
    /// r is the distance of the farthest, or `radius` where there are fewer (Jarosz et al. 2011, table 1: a point asks
    /// beams, with a blur in two dimensions). `most` 0: all within the radius. All groups that beams have must have a
    /// place; `to` comes zeroed.
    void radiance(const Gathering& at, float radius, std::size_t most, Nearest& scratch, std::span<Rgb> to) const;

private:
    static constexpr std::size_t leaf_beams = Nearest::width;

    /// A leaf holds beams, any other node the one behind it, and another.
    struct Node {
        Box box;
        std::uint32_t first;   // of its beams
        std::uint32_t beyond;  // its other child; 0: it is a leaf
    };

    /// Of as many beams as a leaf has, side by side; where there are fewer, the last have no length.
    struct Columns {
        std::array<std::array<float, leaf_beams>, 3> from{}, along{};
        std::array<float, leaf_beams> length{};
    };

    void build(std::uint32_t first, std::uint32_t count);
    void put_in_columns();
    std::span<const Nearest::Item> find(Vec3 position, float radius, std::size_t most, Nearest& scratch) const;
    void offer_leaf(std::size_t leaf, Vec3 position, Nearest& scratch) const;

    std::vector<PhotonBeam> beams_;
    std::vector<Node> nodes_;
    std::vector<Columns> leaves_;  // all but the last are full
};

}  // namespace lightnet
