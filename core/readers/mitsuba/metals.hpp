// The metals that Mitsuba knows by name.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/readers/common/spectra.hpp"

namespace lightnet::mitsuba {

struct ComplexIndex {
    SurfaceColour eta, k;
};
/// Of a metal ("Au"). None: there is none of that name.
std::optional<ComplexIndex> metal_named(const std::string& name);
/// All that there are, for suggestions.
std::vector<std::string> metal_names();

}  // namespace lightnet::mitsuba
