// Importance sampling of many lights: by where they are and where they shine, seen from a point.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/math/vec.hpp"
#include "core/scene/bare_lights/light_bounds.hpp"
#include "core/scene/lamps/few_lights.hpp"
#include "core/scene/lamps/lamp_met.hpp"
#include "core/scene/lamps/lit_point.hpp"

namespace lightnet {

/// A tree over lights (a light BVH), of up to eight children each, which are looked at together. Conty Estévez & Kulla
/// 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting", without the splitting. A few lights
/// are looked at without it. Immutable; any thread may ask.
class LightTree {
public:
    LightTree() = default;
    /// Lights without intensity are never chosen.
    explicit LightTree(const std::vector<LightBounds>& lights);

    /// `u` becomes the place within the choice. None: no light reaches the point.
    std::optional<LightChoice> choose(const LitPoint& from, float& u) const;
    /// Chooses a light for each of many points. Chance 0: no light reaches the point.
    void choose(std::span<const LitPoint> from, std::span<float> places, std::span<LightChoice> chosen) const;
    /// The chance with which choose() finds a light.
    float chance(const LitPoint& from, std::uint32_t light) const;
    /// The chances with which choose() finds each of these.
    void chances(std::span<const LampMet> met, std::span<float> chances) const;

    /// Are there more lights than the nearest cache is likely to hold?
    bool large() const { return nodes_.size() > 64; }
    std::size_t memory() const { return nodes_.size() * sizeof(Node) + place_of_.size() * sizeof(place_of_[0]); }

    static constexpr std::uint32_t width = 8;

    /// Its children, coordinate by coordinate; in whole numbers of steps, so that a million lights stay small.
    struct Node {
        template <class T>
        using Each = std::array<T, width>;
        struct Steps {
            Each<std::uint16_t> x, y, z;
        };
        struct Directions {
            Each<std::int16_t> x, y, z;
        };
        Vec3 low, step;                                        // of the boxes
        Steps lows, highs;                                     // boxes, no smaller than they are
        Directions axis;                                       // in 32767ths
        Each<std::int16_t> cos_spread, sin_spread, cos_reach;  // the same; cosines rounded down
        Each<float> intensity;                                 // 0: there is no such child
        Each<std::uint32_t> child;                             // a node, or, where bit i of `leaves` says so, a light
        std::uint32_t parent = 0;                              // × width, plus which child of it this is
        std::uint8_t leaves = 0, two_sided = 0;                // bits, by child
    };

private:
    struct Choosing;
    struct Looking;

    FewLights few_;  // all of them; none: they are in the tree
    std::vector<Node> nodes_;
    std::vector<std::uint32_t> place_of_;  // by light: its node × width, plus which child of it; none
    static constexpr std::uint32_t none = 0xffffffffu;
};

}  // namespace lightnet
