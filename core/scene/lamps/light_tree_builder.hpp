// Sorts lights into a tree.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/math/vec.hpp"
#include "core/scene/lamps/light_tree.hpp"

namespace lightnet {

/// Splits lights where it parts them best, in space and in direction, and puts eight parts into each node. Half a
/// microsecond of processor time a light; many are sorted on all cores. The tree does not depend on how many those are.
class LightTreeBuilder {
public:
    explicit LightTreeBuilder(const std::vector<LightBounds>& lights);
    /// The nodes, each behind its parent. None: no light shines.
    std::vector<LightTree::Node> build();

private:
    /// A light, whole: what lies side by side in the tree is then read side by side.
    struct Item {
        LightBounds bounds;
        std::uint32_t light = 0;
        Vec3 center() const { return (bounds.low + bounds.high) * 0.5f; }
    };
    struct Part {
        std::uint32_t first, last;
        std::uint32_t size() const { return last - first; }
        std::uint32_t stride() const;  // between lights that tell where to split
    };
    struct Split;
    /// Lights that are a node's child.
    struct Below {
        Part part;
        std::uint32_t place;  // in the parent: its node × children, plus which child
    };
    /// What becomes a node.
    struct Fork {
        std::array<Part, LightTree::width> parts;
        std::array<std::uint32_t, LightTree::width> child;  // of what is more than one light: its fork
        std::uint32_t count, parent;
    };
    /// A fork and those below it, each behind its parent.
    using Branch = std::vector<Fork>;

    void try_axis(Part part, Split split, Vec3 extent, Split& best, float& least_cost) const;
    std::uint32_t halve(Part part);
    std::uint32_t cut(Part whole, std::array<Part, LightTree::width>& parts);
    Branch grow(Part whole, std::uint32_t apart, std::vector<Below>& left);
    void write(const Branch& branch, std::uint32_t start, std::uint32_t place);
    void close(const Fork& fork, std::size_t node);

    std::vector<Item> items_;
    std::vector<LightTree::Node> nodes_;
    std::vector<LightBounds> around_;  // by node
};

}  // namespace lightnet
