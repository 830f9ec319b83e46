#include "core/readers/mitsuba/metals.hpp"

#include <array>
#include <cstddef>
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

/// Those of its documentation that are hardly rendered, many of them no metals: measurements as Palik's handbooks
/// (1985, 1991) have them, seen under D65.
constexpr std::array<NamedMetal, 19> rarer{
    {{"a-C", {{2.452540f, 2.347387f, 2.170983f}, {0.729564f, 0.842877f, 0.894971f}}},
     {"d-C", {{2.411147f, 2.423686f, 2.448769f}, {0, 0, 0}}},
     {"AlAs", {{3.115895f, 3.253897f, 3.662000f}, {0.001086f, 0, 0.010703f}}},
     {"AlSb", {{3.881179f, 4.283822f, 5.046127f}, {0, 0.108789f, 1.362225f}}},
     {"CsI", {{1.779007f, 1.795416f, 1.827111f}, {0, 0, 0}}},
     {"Cu_palik", {{0.119130f, 0.971147f, 1.205361f}, {3.269159f, 2.601773f, 2.362755f}}},
     {"Cu2O", {{2.940355f, 3.109038f, 3.034896f}, {0.083306f, 0.206966f, 0.647858f}}},
     {"CuO", {{2.700314f, 2.581896f, 2.436742f}, {0.422100f, 0.601193f, 0.787817f}}},
     {"HgTe", {{3.997994f, 3.408772f, 2.947760f}, {1.350156f, 1.659288f, 1.892331f}}},
     {"Ni_palik", {{1.974628f, 1.755211f, 1.617089f}, {3.766365f, 3.216047f, 2.599246f}}},
     {"Se", {{3.422264f, 2.995530f, 3.094195f}, {0.641822f, 0.667594f, 0.567522f}}},
     {"SiC", {{2.632417f, 2.664359f, 2.724902f}, {0, 0, 0.000003f}}},
     {"SnTe", {{3.876765f, 2.081735f, 1.432978f}, {0, 0, 0}}},
     {"Ta", {{1.662953f, 2.521466f, 2.883075f}, {1.987423f, 1.844932f, 2.131995f}}},
     {"Te", {{6.252523f, 4.717114f, 2.949781f}, {2.630188f, 3.700409f, 3.618303f}}},
     {"ThF4", {{1.519450f, 1.520886f, 1.525293f}, {0, 0, 0}}},
     {"TiC", {{3.073898f, 2.992782f, 2.845731f}, {2.725919f, 2.480105f, 2.390650f}}},
     {"VC", {{3.043524f, 2.903192f, 2.788921f}, {2.562177f, 2.318579f, 2.162894f}}},
     {"VN", {{2.386847f, 2.235199f, 2.136145f}, {2.541554f, 2.167358f, 1.789319f}}}}};

/// Names with this at their end are of the same measurements, wherever light is visible.
constexpr std::string_view source = "_palik";

template <std::size_t count>
std::optional<ComplexIndex> found(std::string_view name, const std::array<NamedMetal, count>& in) {
    for (const auto& [known, index] : in)
        if (known == name) return ComplexIndex{{index.eta}, {index.k}};
    return std::nullopt;
}

std::optional<ComplexIndex> named_so(const std::string& name) {
    const auto eta = named_index("metal-" + name + "-eta"), k = named_index("metal-" + name + "-k");
    if (eta && k) return ComplexIndex{*eta, *k};
    const auto known = found(name, metals);
    return known ? known : found(name, rarer);
}

}  // namespace

std::optional<ComplexIndex> metal_named(const std::string& name) {
    if (const auto known = named_so(name)) return known;
    if (name.ends_with(source)) return named_so(name.substr(0, name.size() - source.size()));
    return named_so(name + std::string(source));
}

std::vector<std::string> metal_names() {
    std::vector<std::string> names{"Ag", "Al", "Au", "Cu", "MgO", "TiO2", "none"};
    for (const auto& metal : metals) names.emplace_back(metal.name);
    for (const auto& metal : rarer) names.emplace_back(metal.name);
    return names;
}

}  // namespace lightnet::mitsuba
