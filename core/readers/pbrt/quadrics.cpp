#include "core/readers/pbrt/quadrics.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include "core/scene/shapes/placed_quadric.hpp"

namespace lightnet::pbrt {
namespace {

constexpr float turn_of_all = 2 * std::numbers::pi_v<float>;

float turn_of(Parameters& parameters) {
    return std::clamp(parameters.number("phimax", 360), 0.0f, 360.0f) / 360 * turn_of_all;
}

Matrix scaled(double across, double along, double height) {
    Matrix m;
    m.m[0][0] = m.m[1][1] = across, m.m[2][2] = along, m.m[2][3] = height;
    return m;
}

bool is_radius(float radius, Parameters& parameters) {
    if (!(radius > 0)) parameters.error("the radius must be above 0");
    return radius > 0;
}

std::optional<Geometry> stood(Quadric quadric, const Matrix& own, Parameters& parameters, const Placement& placement) {
    quadric.flip_normals = placement.flips();
    quadric.to_world = placement.to_world * own;
    if (quadric.turn > 0 && PlacedQuadric(quadric).usable()) return quadric;
    parameters.warn("it has no extent, or one that is not finite, and is left out");
    return std::nullopt;
}

}  // namespace

std::optional<Geometry> sphere_part(const SpherePart& part, Parameters& parameters, const Placement& placement) {
    Quadric quadric;
    quadric.round = Quadric::Round::sphere;
    quadric.low = std::clamp(part.z_min / part.radius, -1.0f, 1.0f);
    quadric.high = std::clamp(part.z_max / part.radius, -1.0f, 1.0f);
    quadric.turn = part.phi_max;
    if (!(quadric.low < quadric.high)) quadric.turn = 0;
    return stood(quadric, scaled(part.radius, part.radius, 0), parameters, placement);
}

std::optional<Geometry> disk(Parameters& parameters, const Placement& placement) {
    const float height = parameters.number("height", 0), radius = parameters.number("radius", 1);
    Quadric quadric;
    quadric.inner = std::max(0.0f, parameters.number("innerradius", 0));
    quadric.turn = turn_of(parameters);
    if (!is_radius(radius, parameters)) return std::nullopt;
    quadric.inner /= radius;
    if (!(quadric.inner < 1)) quadric.turn = 0;
    return stood(quadric, scaled(radius, 1, height), parameters, placement);
}

std::optional<Geometry> cylinder(Parameters& parameters, const Placement& placement) {
    const float radius = parameters.number("radius", 1), turn = turn_of(parameters);
    auto [low, high] = std::minmax({parameters.number("zmin", -1), parameters.number("zmax", 1)});
    if (!is_radius(radius, parameters)) return std::nullopt;
    Quadric quadric;
    quadric.round = Quadric::Round::cylinder;
    quadric.turn = turn;
    return stood(quadric, scaled(radius, double{high} - low, low), parameters, placement);
}

}  // namespace lightnet::pbrt
