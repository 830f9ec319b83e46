#include "core/readers/common/lamp_tilt.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/base/math/sampling.hpp"

namespace lightnet {
namespace {

float degrees(float radians) { return radians * 180 / pi; }

float part_of_1(float x) { return std::clamp(x, -1.0f, 1.0f); }

}  // namespace

float LampTilt::at(float degrees) const {
    if (angles.empty()) return 1;
    const auto above = std::upper_bound(angles.begin(), angles.end(), degrees);
    if (above == angles.begin()) return factors.front();
    if (above == angles.end()) return factors.back();
    const auto second = static_cast<std::size_t>(above - angles.begin());
    const float share = (degrees - angles[second - 1]) / (angles[second] - angles[second - 1]);
    return factors[second - 1] + (factors[second] - factors[second - 1]) * share;
}

float LampTilt::factor(const Matrix& luminaire, Vec3 up) const {
    if (angles.empty()) return 1;
    const Vec3 own = transform_normal(luminaire, up);  // turned back into its own axes
    if (lamp == Lamp::vertical) return at(degrees(std::acos(part_of_1(own.z))));
    if (lamp == Lamp::stays_horizontal) return at(degrees(std::asin(part_of_1(std::fabs(own.y)))));
    const float from_horizontal = degrees(std::asin(part_of_1(std::fabs(own.x))));
    // a luminaire that shines upwards has turned further, which some tables tell apart
    return at(own.z < 0 && angles.back() > 90 ? 180 - from_horizontal : from_horizontal);
}

bool LampTilt::varies() const {
    return std::adjacent_find(factors.begin(), factors.end(), std::not_equal_to<>{}) != factors.end();
}

}  // namespace lightnet
