#include "core/readers/pbrt/colour_space.hpp"

#include <algorithm>
#include <array>

#include "core/readers/common/spectra.hpp"

namespace lightnet::pbrt {
namespace {

using Rows = std::array<std::array<float, 3>, 3>;

// Rec. ITU-R BT.2020 and SMPTE RP 431-2 (with white D65, as pbrt has it) by their primaries; SMPTE ST 2065-1 adapted
// from D60 by Bradford's matrix.
constexpr Rows from_rec2020{
    {{1.660491f, -0.587641f, -0.072850f}, {-0.124550f, 1.132900f, -0.008349f}, {-0.018151f, -0.100579f, 1.118730f}}};
constexpr Rows from_dci_p3{
    {{1.224940f, -0.224940f, 0.0f}, {-0.042057f, 1.042057f, 0.0f}, {-0.019638f, -0.078636f, 1.098274f}}};
constexpr Rows from_aces{
    {{2.521686f, -1.134131f, -0.387555f}, {-0.276480f, 1.372719f, -0.096239f}, {-0.015378f, -0.152975f, 1.168353f}}};

Rgb through(const Rows& m, Rgb c) {
    const auto row = [&](int i) { return m[i][0] * c.r + m[i][1] * c.g + m[i][2] * c.b; };
    return {row(0), row(1), row(2)};
}

}  // namespace

const std::vector<std::string>& colour_space_names() {
    static const std::vector<std::string> names{"srgb", "dci-p3", "rec2020", "aces2065-1"};
    return names;
}

std::optional<ColourSpace> colour_space_named(const std::string& name) {
    const auto& names = colour_space_names();
    const auto found = std::find(names.begin(), names.end(), name);
    return found == names.end() ? std::nullopt : std::optional(static_cast<ColourSpace>(found - names.begin()));
}

Rgb to_srgb(Rgb colour, ColourSpace from) {
    switch (from) {
        case ColourSpace::dci_p3:
            return through(from_dci_p3, colour);
        case ColourSpace::rec2020:
            return through(from_rec2020, colour);
        case ColourSpace::aces2065_1:
            return through(from_aces, colour);
        default:
            return colour;
    }
}

Rgb white_light(ColourSpace space) {
    return space == ColourSpace::aces2065_1 ? daylight_colour(6000).rgb : Rgb{1, 1, 1};
}

}  // namespace lightnet::pbrt
