// The Beckmann law of microfacets, whose slopes are distributed normally: Walter et al. 2007.
#pragma once

#include <cmath>

#include "core/base/math/sampling.hpp"
#include "core/base/math/vec.hpp"

namespace lightnet {

/// As GgxLaw.
struct BeckmannLaw {
    static float density(float across2, float z2) { return std::exp(-across2 / z2) * inverse_pi / (z2 * z2); }
    static float lambda(float across2, float z2) {
        constexpr float inverse_root_pi = 0.5641895835f;
        const float a = std::sqrt(z2 / across2);  // across2 = 0: nothing is hidden
        return across2 > 0 ? 0.5f * (inverse_root_pi * std::exp(-a * a) / a - std::erfc(a)) : 0;
    }
    /// As that of GgxLaw. The slope along `w` by inversion of its distribution: Heitz and d'Eon 2014, "Importance
    /// Sampling Microfacet-Based BSDFs using the Distribution of Visible Normals"; the search within erf's range is
    /// that of Jakob 2014, "An Improved Visible Normal Sampling Routine for the Beckmann Distribution".
    static Vec3 sample_visible(Vec3 w, Vec2 u);
};

}  // namespace lightnet
