#include "core/scene/shapes/quadric.hpp"

#include "core/base/math/moved_box.hpp"
#include "core/scene/shapes/placed_quadric.hpp"

#include <algorithm>
#include <cmath>

namespace lightnet {

std::string Quadric::fault() const { return placed().usable() ? "" : "its transform can't be inverted"; }

void Quadric::add_to(Box& box, const Matrix& by) const { add_moved(box, placed().bounds(), by); }

float Quadric::extent() const {
    const Box box = placed().bounds();
    const auto far = [](Vec3 p) { return std::fabs(p.x) + std::fabs(p.y) + std::fabs(p.z); };
    return std::max(far(box.low), far(box.high));
}

double Quadric::area() const { return placed().area(); }

PlacedQuadric Quadric::placed() const { return PlacedQuadric(*this); }

}  // namespace lightnet
