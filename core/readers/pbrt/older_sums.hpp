// Sums of reflections, of which the materials of pbrt-v3 are made: as mixtures that come to the same.
#pragma once

#include <functional>
#include <vector>

#include "core/readers/pbrt/materials.hpp"

namespace lightnet::pbrt {

/// What the makers of pbrt-v3's materials look things up in, and put parts of materials into.
struct OlderSources {
    MaterialSources known;
    std::function<MaterialId(Material)> add;
};

/// One of several reflections of a surface, which add up.
struct Reflection {
    float most = 1;       // the largest part of its colour
    bool bounded = true;  // its colour must stay below 1 when it is made stronger
    std::function<Material(float gain)> make;
};

/// A mixture in which each has a share, and is made stronger by one over that: exactly the sum, as long as no more
/// comes back than arrives.
Material sum_of(const std::vector<Reflection>& parts, Parameters& parameters, const OlderSources& sources);

}  // namespace lightnet::pbrt
