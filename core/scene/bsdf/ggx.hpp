// The GGX law of microfacets: Walter et al. 2007.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/base/math/sampling.hpp"
#include "core/base/math/vec.hpp"

namespace lightnet {

/// For facets of α = 1; see Microfacets, which stretches them. Directions are split: `across2` is the square of what is
/// within the surface, `z2` of what is along its normal.
struct GgxLaw {
    static float density(float across2, float z2) {
        const float s = across2 + z2;
        return inverse_pi / (s * s);
    }
    static float lambda(float across2, float z2) { return 0.5f * (std::sqrt(1 + across2 / z2) - 1); }
    /// A normal that `w`, a unit vector above the surface, sees; of any length. Heitz 2018, "Sampling the GGX
    /// Distribution of Visible Normals".
    static Vec3 sample_visible(Vec3 w, Vec2 u) {
        const float across = w.x * w.x + w.y * w.y;
        const bool slanted = across > 1e-8f;
        const float per_across = 1 / std::sqrt(across);
        const Vec3 t1{slanted ? -w.y * per_across : 1, slanted ? w.x * per_across : 0, 0};
        const Vec3 t2 = cross(w, t1);
        const Vec2 d = disk(u);
        const auto root = [](float square) { return std::sqrt(square > 0 ? square : 0); };
        const float half = root(1 - d.x * d.x);
        const float s = 0.5f * (1 + w.z);
        const float y = (1 - s) * half + s * d.y;
        const float z = root(1 - d.x * d.x - y * y);
        return t1 * d.x + t2 * y + w * z;
    }
};

}  // namespace lightnet
