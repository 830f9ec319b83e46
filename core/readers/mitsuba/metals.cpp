#include "core/readers/mitsuba/metals.hpp"

#include <array>
#include <string_view>

namespace lightnet::mitsuba {
namespace {

struct NamedMetal {
    std::string_view name;
    struct {
        Rgb eta, k;
    } index;
};

/// Those that pbrt doesn't name: the usual RGB values of the same measurements.
constexpr std::array<NamedMetal, 13> metals{
    {{"Be", {{4.185059f, 3.185060f, 2.784091f}, {3.835440f, 3.010126f, 2.869009f}}},
     {"Cr", {{4.369683f, 2.916702f, 1.654700f}, {5.206434f, 4.231365f, 3.754947f}}},
     {"Hg", {{2.398931f, 1.440025f, 0.909551f}, {6.327627f, 4.371941f, 3.421790f}}},
     {"Ir", {{3.086410f, 2.082194f, 1.617887f}, {5.592151f, 4.067176f, 3.267261f}}},
     {"K", {{0.064049f, 0.046410f, 0.038184f}, {2.104216f, 1.348936f, 0.913211f}}},
     {"Li", {{0.265787f, 0.195610f, 0.220920f}, {3.540174f, 2.311131f, 1.668593f}}},
     {"Mo", {{4.483701f, 3.525458f, 2.776077f}, {4.111131f, 3.420872f, 3.150603f}}},
     {"Na_palik", {{0.060267f, 0.056141f, 0.061991f}, {3.179291f, 2.112480f, 1.579094f}}},
     {"Nb", {{3.420135f, 2.790192f, 2.395586f}, {3.441382f, 2.737644f, 2.579913f}}},
     {"Rh", {{2.585795f, 1.860187f, 1.554428f}, {6.782293f, 4.702950f, 3.976089f}}},
     {"TiN", {{1.648469f, 1.150448f, 1.379780f}, {3.368460f, 1.943489f, 1.102012f}}},
     {"V_palik", {{4.277513f, 3.513154f, 2.761126f}, {3.491184f, 2.889358f, 3.111697f}}},
     {"W", {{4.370703f, 3.300297f, 2.998267f}, {3.500678f, 2.604865f, 2.273193f}}}}};

}  // namespace

std::optional<ComplexIndex> metal_named(const std::string& name) {
    const auto eta = named_index("metal-" + name + "-eta"), k = named_index("metal-" + name + "-k");
    if (eta && k) return ComplexIndex{*eta, *k};
    for (const auto& [known, index] : metals)
        if (known == name) return ComplexIndex{{index.eta}, {index.k}};
    return std::nullopt;
}

std::vector<std::string> metal_names() {
    std::vector<std::string> names;
    for (const auto& metal : metals) names.emplace_back(metal.name);
    for (const char* name : {"Ag", "Al", "Au", "Cu", "MgO", "TiO2", "none"}) names.emplace_back(name);
    return names;
}

}  // namespace lightnet::mitsuba
