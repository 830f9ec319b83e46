#include "core/scene/surfaces/placement.hpp"

#include "core/base/error.hpp"

#include <algorithm>
#include <cmath>

namespace lightnet {
namespace {

float largest(Vec3 v) { return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}); }

}  // namespace

Placement::Placement(const Matrix& to_world, Unchecked) {
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 4; ++column) columns_[3 * column + row] = float(to_world.m[row][column]);
    invert();
}

Placement::Placement(const Placement& before, const Placement& after, float part) {
    for (std::size_t i = 0; i < columns_.size(); ++i)
        columns_[i] = before.columns_[i] * (1 - part) + after.columns_[i] * part;
    invert();
    if (!fault().empty()) *this = before;
}

void Placement::invert() {
    double a[3][3];
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 3; ++column) a[row][column] = columns_[3 * column + row];
    // By cofactors: its rows are the cross products of the columns, over the determinant.
    const auto minor = [&](std::size_t i, std::size_t j) {
        const std::size_t r = (j + 1) % 3, s = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
        return a[r][c] * a[s][d] - a[r][d] * a[s][c];
    };
    const double determinant = a[0][0] * minor(0, 0) + a[1][0] * minor(0, 1) + a[2][0] * minor(0, 2);
    for (std::size_t i = 0; i < 3; ++i)
        inverse_[i] = {float(minor(i, 0) / determinant), float(minor(i, 1) / determinant),
                       float(minor(i, 2) / determinant)};
}

Placement::Placement(const Matrix& to_world) : Placement(to_world, Unchecked{}) {
    if (const std::string why = fault(); !why.empty()) throw Error("scene", why);
}

std::string Placement::fault(const Matrix& to_world) { return Placement(to_world, Unchecked{}).fault(); }

// Embree inverts it in single precision, so that its determinant must be an ordinary number there.
std::string Placement::fault() const {
    const auto& c = columns_;
    const float determinant =
        c[0] * (c[4] * c[8] - c[5] * c[7]) + c[1] * (c[5] * c[6] - c[3] * c[8]) + c[2] * (c[3] * c[7] - c[4] * c[6]);
    constexpr float least = 1e-36f, most = 1e36f;
    bool usable = std::fabs(determinant) >= least && std::fabs(determinant) <= most;
    for (const Vec3 row : inverse_) usable &= finite(row);
    for (const float number : columns_) usable &= std::isfinite(number);
    return usable ? "" : "the transform of an instance can't be inverted";
}

double Placement::largest_stretch() const {
    double most = 0;
    for (const Vec3 row : inverse_)
        most = std::max(most, double{std::fabs(row.x)} + double{std::fabs(row.y)} + double{std::fabs(row.z)});
    return most;
}

double Placement::farthest_inside(double coordinate) const {
    return largest_stretch() * (coordinate + double{largest({columns_[9], columns_[10], columns_[11]})});
}

double Placement::farthest_outside(double inside) const {
    return inside / largest_stretch() - double{largest({columns_[9], columns_[10], columns_[11]})};
}

Vec3 Placement::direction_to_world(Vec3 v) const {
    const auto row = [&](std::size_t i) { return columns_[i] * v.x + columns_[3 + i] * v.y + columns_[6 + i] * v.z; };
    return {row(0), row(1), row(2)};
}

// The nearest that there is in single precision.
Vec3 Placement::point_to_world(Vec3 p) const {
    const auto row = [&](std::size_t i) {
        return double{columns_[i]} * p.x + double{columns_[3 + i]} * p.y + double{columns_[6 + i]} * p.z +
               double{columns_[9 + i]};
    };
    return {float(row(0)), float(row(1)), float(row(2))};
}

Vec3 Placement::point_to_object(Vec3 p) const {
    const Vec3 from_origin = p - Vec3{columns_[9], columns_[10], columns_[11]};
    return {dot(inverse_[0], from_origin), dot(inverse_[1], from_origin), dot(inverse_[2], from_origin)};
}

SurfacePoint Placement::place(const SurfacePoint& point) const {
    // Normals go by the inverse transpose, which keeps them on their side of the surface.
    const auto normal_to_world = [&](Vec3 n) { return inverse_[0] * n.x + inverse_[1] * n.y + inverse_[2] * n.z; };
    const Vec3 gradient = normal_to_world(point.normal);
    const float steepness = length(gradient);  // metres of the object per metre of the world, along the normal

    SurfacePoint placed = point;
    placed.position = point_to_world(point.position);
    placed.normal = gradient / steepness;
    placed.along_u = direction_to_world(point.along_u);
    placed.along_v = direction_to_world(point.along_v);

    // What the point was off in its object, as the world sees it; what the world's own numbers round; and what Embree
    // rounds when it takes a ray into the object, which shear makes worse: where the object's origin stands, and what
    // it multiplies to come there.
    const Vec3 n = magnitudes(point.normal), middle{columns_[9], columns_[10], columns_[11]};
    const Vec3 far = magnitudes(placed.position) + magnitudes(middle),
               from_middle = magnitudes(placed.position - middle);
    const Vec3 rounded = magnitudes(inverse_[0]) * n.x + magnitudes(inverse_[1]) * n.y + magnitudes(inverse_[2]) * n.z;
    const float by_embree = rounding_step * dot(rounded, far * 4 + from_middle * 16);
    placed.offset = offset_at(placed.position, placed.normal, (point.offset + by_embree) / steepness);

    const Vec3 z = normal_to_world(point.shading.z);
    const float size = length(z);
    placed.shading = Frame::around(size > 0 && dot(z, placed.normal) > 0 ? z / size : placed.normal);
    return placed;
}

}  // namespace lightnet
