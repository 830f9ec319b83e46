// Bounds of the light that comes to a point from lights known by their bounds: eight of either at once.
#pragma once

#include "core/base/math/eight.hpp"

namespace lightnet {

/// The cosine and the sine of an angle, times a distance.
struct Turn {
    Eight cosine, sine;
};
/// The angle less another one: at least 0.
[[gnu::always_inline]] inline Turn less(const Turn& angle, const Eight& distance, const Eight& cosine,
                                        const Eight& sine) {
    const Mask none_left = angle.cosine > distance * cosine;
    return {select(none_left, distance, angle.cosine * cosine + angle.sine * sine),
            select(none_left, all_of(0.0f), angle.sine * cosine - angle.cosine * sine)};
}

struct EightVectors {
    Eight x, y, z;
};
/// Lights as LightBounds has them: the ball around the box, and the cone. Eight, or eight times the same.
struct EightLights {
    EightVectors middle;
    Eight radius2, radius;
    EightVectors axis;
    Eight cos_spread, sin_spread, cos_reach, intensity;
    Mask two_sided;
};
/// Points that are lit (LitPoint). Eight, or eight times the same.
struct EightPoints {
    EightVectors at, normal;
    Mask any_side;  // there is no normal
};

/// A ball as it is seen from a point: distance² and its reciprocal, its radius, and how far its rim is.
struct SeenBounds {
    Eight square, per_square, radius, rim;
    // The cosine of the angle less the one that the ball fills. Worked out times the distance, and the difference times
    // its square, so that no root waits for another, nor for the quotient.
    [[gnu::always_inline]] Eight cosine_beyond(const Turn& angle) const {
        return select(angle.cosine > rim, square, angle.cosine * rim + angle.sine * radius) * per_square;
    }
};

/// Of Conty Estévez & Kulla 2018, section 4.1: intensity × cosines / distance², the cosines as large as any light
/// within the bounds could have them.
/// DECISIONS: tree-of-lamps
[[gnu::always_inline]] inline Eight importance(const EightLights& light, const EightPoints& point) {
    constexpr float roundings = 3e-4f;
    // Of light that arrives, as what counts it by: where the shading normal leans over, the true normal's cosine may
    // be 0.
    constexpr float least_cosine = 0.05f;
    const EightVectors way{point.at.x - light.middle.x, point.at.y - light.middle.y, point.at.z - light.middle.z};
    const Eight distance2 = way.x * way.x + way.y * way.y + way.z * way.z;
    // As near as the size of the box the distance says nothing.
    const Eight square = greater_of(distance2, greater_of(light.radius2, all_of(1e-30f)));
    const SeenBounds seen{square, 1 / square, light.radius, root(square - light.radius2)};
    const Eight distance = root(square), falloff = light.intensity * seen.per_square;

    const Eight along = way.x * light.axis.x + way.y * light.axis.y + way.z * light.axis.z;
    const Turn to_axis{select(light.two_sided, magnitude(along), along), root(magnitude(square - along * along))};
    const Eight cos_leaving = seen.cosine_beyond(less(to_axis, distance, light.cos_spread, light.sin_spread));
    const Eight lit =
        select(cos_leaving < light.cos_reach - roundings, all_of(0.0f), greater_of(cos_leaving, all_of(roundings)));
    const EightVectors& n = point.normal;
    const Eight up = way.x * -n.x + way.y * -n.y + way.z * -n.z;
    const Eight cos_arriving = seen.cosine_beyond({up, root(magnitude(square - up * up))});
    const Eight above = select(cos_arriving < -roundings, all_of(0.0f), greater_of(cos_arriving, all_of(least_cosine)));
    const Mask inside = distance2 <= light.radius2;  // the box is all around: any direction is possible
    return falloff * select(inside, all_of(1.0f), lit * select(point.any_side, all_of(1.0f), above));
}

}  // namespace lightnet
