// The GGX distribution of microfacets, with height-correlated shadowing. All directions are local: the normal is +z.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/base/math/sampling.hpp"
#include "core/base/math/vec.hpp"

namespace lightnet {

/// Walter et al. 2007 and Heitz 2014; anisotropic. A value.
struct Ggx {
    float alpha_u = 0, alpha_v = 0;

    /// Density of normals `m`, per steradian.
    float density(Vec3 m) const {
        const float x = m.x / alpha_u, y = m.y / alpha_v;
        const float s = x * x + y * y + m.z * m.z;
        return inverse_pi / (alpha_u * alpha_v * s * s);
    }
    /// Smith's Λ: 1/(1 + Λ) of the microfacets facing `w` are visible from it.
    float lambda(Vec3 w) const {
        const float x = alpha_u * w.x, y = alpha_v * w.y, z2 = w.z * w.z;
        return z2 == 0 ? 1e18f : 0.5f * (std::sqrt(1 + (x * x + y * y) / z2) - 1);
    }
    float visible(Vec3 w) const { return 1 / (1 + lambda(w)); }
    /// Seen from both directions; heights correlated (Heitz 2014, eq. 99).
    float visible(Vec3 a, Vec3 b) const { return 1 / (1 + lambda(a) + lambda(b)); }
    /// A visible normal. Heitz 2018, "Sampling the GGX Distribution of Visible Normals".
    Vec3 sample_visible(Vec3 w, Vec2 u) const {
        Vec3 stretched = normalize({alpha_u * w.x, alpha_v * w.y, w.z});
        if (stretched.z < 0) stretched = -stretched;
        const float across = stretched.x * stretched.x + stretched.y * stretched.y;
        const Vec3 t1 = across > 1e-8f ? Vec3{-stretched.y, stretched.x, 0} / std::sqrt(across) : Vec3{1, 0, 0};
        const Vec3 t2 = cross(stretched, t1);
        const Vec2 d = disk(u);
        const float half = std::sqrt(std::max(0.0f, 1 - d.x * d.x));
        const float s = 0.5f * (1 + stretched.z);
        const float y = (1 - s) * half + s * d.y;
        const float z = std::sqrt(std::max(0.0f, 1 - d.x * d.x - y * y));
        const Vec3 n = t1 * d.x + t2 * y + stretched * z;
        return normalize({alpha_u * n.x, alpha_v * n.y, std::max(1e-6f, n.z)});
    }
};

}  // namespace lightnet
