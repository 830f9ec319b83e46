// Sorts lights into a tree.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/math/vec.hpp"
#include "core/scene/lamps/light_tree.hpp"

namespace lightnet {

/// Splits lights where it parts them best, in space and in direction, and puts eight parts into each node. Some 300 ns
/// a light; many are sorted on all cores. The tree does not depend on how many those are.
class LightTreeBuilder {
public:
    explicit LightTreeBuilder(const std::vector<LightBounds>& lights);
    /// The nodes, each behind its parent. None: no light shines.
    std::vector<LightTree::Node> build();

private:
    /// What splitting has to know of a light: little, as all of them are looked at at each level.
    struct Item {
        Vec3 center;
        float radius = 0;
        Vec3 axis;  // mean direction times intensity
        float intensity = 0;
        std::uint32_t light = 0;
    };
    struct Part {
        std::uint32_t first, last;
        std::uint32_t size() const { return last - first; }
    };
    struct Split;
    /// Lights that are a node's child.
    struct Below {
        Part part;
        std::uint32_t place;  // in the parent: its node × children, plus which child
    };
    /// A node and those below it, each behind its parent.
    struct Branch {
        std::vector<LightTree::Node> nodes;
        std::vector<LightBounds> bounds;  // by node: around all of it
    };

    void try_axis(Part part, Split split, Vec3 extent, Split& best, float& least_cost) const;
    std::uint32_t halve(Part part);
    std::uint32_t cut(Part whole, std::array<Part, LightTree::width>& parts);
    Branch grow(Part whole, std::uint32_t apart, std::vector<Below>& left);
    void close(Branch& branch) const;
    void close(Branch& branch, std::size_t node) const;
    static void append(const Branch& branch, std::uint32_t place, Branch& to);

    const std::vector<LightBounds>& lights_;
    std::vector<Item> items_;
};

}  // namespace lightnet
