// Reflectance of a flat interface.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/base/math/rgb.hpp"
#include "core/base/math/vec.hpp"

namespace lightnet {

/// Unpolarised reflectance of a dielectric. `cosine` of the arriving direction, positive outside; `eta` inside over
/// outside. 1 where all is reflected.
inline float fresnel_dielectric(float cosine, float eta) {
    // Without a branch, as loops over many surfaces want it.
    const bool inside = cosine < 0;
    cosine = std::fabs(cosine);
    cosine = cosine < 1 ? cosine : 1;
    const float turned = 1 / eta;
    eta = inside ? turned : eta;
    const float sine2_t = (1 - cosine * cosine) / (eta * eta);
    const float cosine_t = std::sqrt(std::fabs(1 - sine2_t));
    const float parallel = (eta * cosine - cosine_t) / (eta * cosine + cosine_t);
    const float perpendicular = (cosine - eta * cosine_t) / (cosine + eta * cosine_t);
    const float reflected = 0.5f * (parallel * parallel + perpendicular * perpendicular);
    return sine2_t >= 1 ? 1 : reflected;
}

/// Unpolarised reflectance of a conductor with the complex index eta + i k, for cosine in [0,1]. Lagarde 2013, "Memo on
/// Fresnel equations", as in pbrt.
inline float fresnel_conductor(float cosine, float eta, float k) {
    cosine = cosine > 0 ? cosine : 0;
    cosine = cosine < 1 ? cosine : 1;
    const float cos2 = cosine * cosine, sin2 = 1 - cos2;
    const float t0 = eta * eta - k * k - sin2;
    const float a2_plus_b2 = std::sqrt(t0 * t0 + 4 * eta * eta * k * k);
    const float t1 = a2_plus_b2 + cos2;
    const float a2 = 0.5f * (a2_plus_b2 + t0);
    const float a = std::sqrt(a2 > 0 ? a2 : 0);
    const float t2 = 2 * cosine * a;
    const float perpendicular = (t1 - t2) / (t1 + t2);
    const float t3 = cos2 * a2_plus_b2 + sin2 * sin2;
    const float t4 = t2 * sin2;
    const float parallel = perpendicular * (t3 - t4) / (t3 + t4);
    const float reflected = 0.5f * (perpendicular + parallel), least = reflected > 0 ? reflected : 0;
    return least < 1 ? least : 1;
}

inline Rgb fresnel_conductor(float cosine, Rgb eta, Rgb k) {
    return {fresnel_conductor(cosine, eta.r, k.r), fresnel_conductor(cosine, eta.g, k.g),
            fresnel_conductor(cosine, eta.b, k.b)};
}

inline Vec3 reflect(Vec3 w, Vec3 n) { return n * (2 * dot(w, n)) - w; }

/// A refracted direction.
struct Refracted {
    Vec3 direction;
    float eta = 1;          // index on its side over the index on the arriving side
    bool possible = false;  // false: total internal reflection
};

/// Refracts `w` (away from the surface) at the microfacet `n`; `eta` inside over outside, where `n` points outside.
inline Refracted refract(Vec3 w, Vec3 n, float eta) {
    float cosine = dot(w, n);
    if (cosine < 0) {
        eta = 1 / eta;
        cosine = -cosine;
        n = -n;
    }
    const float sine2_t = std::max(0.0f, 1 - cosine * cosine) / (eta * eta);
    if (sine2_t >= 1) return {};
    const float cosine_t = std::sqrt(1 - sine2_t);
    return {n * (cosine / eta - cosine_t) - w * (1 / eta), eta, true};
}

}  // namespace lightnet
