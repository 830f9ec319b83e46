// Importance sampling of many lights: by where they are and where they shine, seen from a point.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/math/vec.hpp"

namespace lightnet {

/// Where some lights are and into which directions they shine: a box, and a cone of normals around which each of them
/// shines within an angle.
struct LightBounds {
    Vec3 low, high;
    Vec3 axis{0, 0, 1};    // unit
    float cos_spread = 1;  // of the greatest angle between the axis and a normal
    float cos_reach = 0;   // of the greatest angle, from a normal, at which light leaves; at most a right angle
    float intensity = 0;   // W·sr⁻¹, along the normals, of all together
    bool two_sided = false;
};

/// A binary tree over lights (a light BVH). Conty Estévez & Kulla 2018, "Importance Sampling of Many Lights with
/// Adaptive Tree Splitting", without the splitting. Immutable; any thread may ask.
class LightTree {
public:
    LightTree() = default;
    /// Lights without intensity are never chosen.
    explicit LightTree(const std::vector<LightBounds>& lights);

    struct Choice {
        std::uint32_t light;
        float chance;
    };
    /// `u` becomes the place within the choice. None: no light reaches the point.
    std::optional<Choice> choose(Vec3 from, float& u) const;
    /// The chance with which choose() finds a light.
    float chance(Vec3 from, std::uint32_t light) const;

    std::size_t memory() const { return nodes_.size() * sizeof(Node) + leaf_of_.size() * sizeof(leaf_of_[0]); }

private:
    struct Node {
        Vec3 center, half;  // of the box
        Vec3 axis;
        float radius2;  // of the ball around the box
        float cos_spread, sin_spread, cos_reach;
        float intensity;
        std::uint32_t second = 0;  // child; the first one stands behind its parent. 0: a leaf
        std::uint32_t parent = 0;  // of a leaf and of any other
        std::uint32_t light = 0;   // of a leaf
        bool two_sided;
    };
    struct Builder;
    static Node node_of(const LightBounds& bounds);
    static float importance(const Node& node, Vec3 from);

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> leaf_of_;  // by light; none
    static constexpr std::uint32_t none = 0xffffffffu;
};

}  // namespace lightnet
