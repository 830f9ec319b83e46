// The place of an instance of an object.
#pragma once

#include <array>
#include <string>

#include "core/base/math/transform.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/surfaces/surface.hpp"

namespace lightnet {

/// An affine transform as rays see it: in single precision.
class Placement {
public:
    /// Throws Error when the transform can't be inverted.
    explicit Placement(const Matrix& to_world);
    /// Between two, each number evenly, as Embree does it. What can't be inverted there is as it was before.
    Placement(const Placement& before, const Placement& after, float part);
    /// Why it can't be one; "": it can.
    static std::string fault(const Matrix& to_world);

    /// Columns, as Embree wants them: x, y and z axis, then the origin.
    const std::array<float, 12>& columns() const { return columns_; }
    /// A point of the object's surface, in world space. Its frame follows no texture.
    SurfacePoint place(const SurfacePoint& point) const;
    Vec3 point_to_world(Vec3 p) const;
    Vec3 point_to_object(Vec3 p) const;
    /// The largest coordinate that a point of the world, none of whose own is larger than this, may have in the object.
    double farthest_inside(double coordinate) const;
    /// The largest in the world of which none in the object is larger than that.
    double farthest_outside(double inside) const;

private:
    struct Unchecked {};
    Placement(const Matrix& to_world, Unchecked);
    void invert();
    std::string fault() const;
    double largest_stretch() const;
    Vec3 direction_to_world(Vec3 v) const;

    std::array<float, 12> columns_;
    std::array<Vec3, 3> inverse_;  // rows of the inverse's linear part
};

}  // namespace lightnet
