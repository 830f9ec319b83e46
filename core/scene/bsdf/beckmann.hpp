// The Beckmann law of microfacets, whose slopes are distributed normally: Walter et al. 2007.
#pragma once

#include <cmath>

#include "core/base/math/exponential.hpp"
#include "core/base/math/sampling.hpp"
#include "core/base/math/vec.hpp"

namespace lightnet {

/// As GgxLaw.
struct BeckmannLaw {
    static constexpr float inverse_root_pi = 0.5641895835f;
    static constexpr float least = 1e-6f;  // of what is inverted: erf's range is open

    [[gnu::always_inline]] static float density(float across2, float z2) {
        return exponential(-across2 / z2) * inverse_pi / (z2 * z2);
    }
    [[gnu::always_inline]] static float lambda(float across2, float z2) {
        const float a = std::sqrt(z2 / across2);  // across2 = 0: nothing is hidden
        const float hidden = 0.5f * (inverse_root_pi * exponential(-a * a) / a - complementary_error(a));
        const float rounded = hidden > 0 ? hidden : 0;
        return across2 > 0 ? rounded : 0;
    }
    /// As that of GgxLaw. The slope along `w` by inversion of its distribution: Heitz and d'Eon 2014, "Importance
    /// Sampling Microfacet-Based BSDFs using the Distribution of Visible Normals"; the search within erf's range is
    /// that of Jakob 2014, "An Improved Visible Normal Sampling Routine for the Beckmann Distribution".
    [[gnu::always_inline]] static Vec3 sample_visible(Vec3 w, Vec2 u) {
        const float across = std::sqrt(w.x * w.x + w.y * w.y), per_across = 1 / across;
        const bool slanted = across > 1e-4f;
        const Vec2 along{slanted ? w.x * per_across : 1, slanted ? w.y * per_across : 0};
        const float x = visible_slope(across, w.z > 1e-6f ? w.z : 1e-6f, u.x);
        const float y = inverse_error(within(2 * u.y - 1));
        return {-(along.x * x - along.y * y), -(along.y * x + along.x * y), 1};
    }

private:
    [[gnu::always_inline]] static float within(float s) {
        const float above = s > least - 1 ? s : least - 1;
        return above < 1 - least ? above : 1 - least;
    }
    /// The slope of a facet that a direction of that sine and cosine sees, along it.
    [[gnu::always_inline]] static float visible_slope(float sine, float cosine, float u) {
        const float tangent = sine / cosine, cotangent = cosine / (sine > 1e-7f ? sine : 1e-7f);
        // Up to erf(x) = s lie 1 + s + tangent e^(-x²)/√π of all, divided by what lies up to x = 1/tangent, where
        // facets turn away.
        const auto up_to = [&](float s, float x) { return 1 + s + tangent * inverse_root_pi * exponential(-x * x); };
        const float high = 1 - complementary_error(cotangent), place = u > least ? u : least;
        const float all = up_to(high, cotangent), wanted = place * all;
        float s = first_guess(cosine, high, place);
        // Newton's steps: after three, less than 3e-6 of all is missing, whatever the angle and the place.
#pragma GCC unroll 3
        for (int step = 0; step < 3; ++step) {
            const float x = inverse_error(within(s));
            const float next = s - (up_to(s, x) - wanted) / (1 - x * tangent);
            const float above = next > -1 ? next : -1;
            s = above < high ? above : high;
        }
        return inverse_error(within(s));
    }
    /// Jakob's fit.
    [[gnu::always_inline]] static float first_guess(float cosine, float high, float place) {
        // the angle: Abramowitz and Stegun 4.4.45
        const float angle = std::sqrt(cosine < 1 ? 1 - cosine : 0) *
                            (1.5707288f + cosine * (-0.2121144f + cosine * (0.0742610f - cosine * 0.0187293f)));
        const float power = 1 + angle * (-0.876f + angle * (0.4265f - 0.0594f * angle));
        const float left = 1 - place > 1e-7f ? 1 - place : 1e-7f;
        return high - (1 + high) * exponential(power * logarithm(left));
    }
};

}  // namespace lightnet
