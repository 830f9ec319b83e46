// Angles as parts of a whole turn, and back, without a branch: loops over many become vectors. Their own series, so
// that results are the same on every libm.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/base/math/sampling.hpp"

namespace lightnet {

/// The angle of the point (x, y), seen from the origin, from the x axis towards the y axis, over 2π: in [-1/2, 1/2],
/// and 0 for the origin. Within 2e-7 of its value. The series is that of Cephes (Moshier 1989, "Methods and Programs
/// for Mathematical Functions"), after one reduction.
[[gnu::always_inline]] inline float turns(float y, float x) {
    const float along = std::fabs(x), across = std::fabs(y);
    const bool steep = across > along;
    const float large = steep ? across : along, small = steep ? along : across;
    const float t = small / (large > 0 ? large : 1);
    const bool wide = t > 0.41421356f;  // tan π/8
    const float r = wide ? (t - 1) / (t + 1) : t, q = r * r;
    const float series =
        r + r * q * (-3.33329491539e-1f + q * (1.99777106478e-1f + q * (-1.38776856032e-1f + q * 8.05374449538e-2f)));
    const float near_axis = series * (0.5f * inverse_pi) + (wide ? 0.125f : 0);
    const float first = steep ? 0.25f - near_axis : near_axis;
    return std::copysign(x < 0 ? 0.5f - first : first, y);
}

/// Sine and cosine of an angle of so many turns, of which there are few; within 2e-7.
[[gnu::always_inline]] inline SineCosine sine_cosine_of_turns(float turns) {
    const float quarter = std::floor(4 * turns + 0.5f);
    const auto [s, c] = sine_cosine_near_zero(2 * pi * (turns - 0.25f * quarter));
    const int which = int(quarter) & 3;
    const float sine = which & 1 ? c : s, cosine = which & 1 ? s : c;
    return {which & 2 ? -sine : sine, (which + 1) & 2 ? -cosine : cosine};
}

}  // namespace lightnet
