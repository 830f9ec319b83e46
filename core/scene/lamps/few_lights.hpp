// Importance sampling of so few lights that each of them is looked at.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/scene/bare_lights/light_bounds.hpp"
#include "core/scene/lamps/lamp_met.hpp"
#include "core/scene/lamps/lit_point.hpp"

namespace lightnet {

/// As LightTree, by the importance of each light itself. Immutable; any thread may ask.
/// DECISIONS: few-lamps-without-a-tree
class FewLights {
public:
    static constexpr std::uint32_t most = 32;

    FewLights() = default;
    /// At most `most` of the lights have intensity; the others are never chosen.
    explicit FewLights(const std::vector<LightBounds>& lights);

    bool empty() const { return count_ == 0; }
    /// `places` become the places within the choices.
    void choose(std::span<const LitPoint> from, std::span<float> places, std::span<LightChoice> chosen) const;
    /// The chances with which choose() finds lights.
    void chances(std::span<const LampMet> met, std::span<float> chances) const;

private:
    using Each = std::array<float, most>;
    /// Light by light, number by number.
    struct Lights {
        alignas(32) Each middle_x{}, middle_y{}, middle_z{}, radius2{}, radius{}, axis_x{}, axis_y{}, axis_z{};
        alignas(32) Each cos_spread{}, sin_spread{}, cos_reach{}, intensity{};
        alignas(32) std::array<std::int32_t, most> two_sided{};  // -1: yes
        std::array<std::uint32_t, most> name{};                  // as it was given
    };
    struct Choosing;
    struct Looking;

    std::uint32_t count_ = 0;
    Lights lights_;
    std::vector<std::uint32_t> place_of_;  // by light; `most`: it has no intensity
};

}  // namespace lightnet
