// A shape that moves while the shutter is open.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>

#include "core/base/math/box.hpp"
#include "core/base/math/shutter.hpp"
#include "core/scene/data/scene_data.hpp"
#include "core/scene/surfaces/triangle.hpp"

namespace lightnet {

/// Where a shape is at each time. Looks at the scene's data. Any thread may ask.
class MovingShape {
public:
    /// `later`: of the same kind, and of as many vertices.
    MovingShape(const ShapeGeometry& first, std::span<const ShapeGeometry> later) : first_(first), later_(later) {}

    std::size_t steps() const { return later_.size() + 1; }
    const ShapeGeometry& at_step(std::size_t step) const { return step == 0 ? first_ : later_[step - 1]; }

    /// Of a mesh: the corners of a triangle, and their shading normals; of one without normals no more than nothing.
    Corners corners(std::uint32_t triangle, ShutterTime time) const;
    Corners normals(std::uint32_t triangle, ShutterTime time) const;
    /// Of what is one. `open`: part of the shutter's time.
    Sphere sphere(float open) const;
    Quadric quadric(float open) const;

    /// use(what the shape is placed as) at a time: of a mesh it is its first step, which has the triangles.
    template <class Use>
    auto placed(float open, const Use& use) const {
        if (const auto* mesh = std::get_if<Mesh>(&first_)) return use(mesh);
        if (std::holds_alternative<Quadric>(first_)) {
            const Quadric quadric = this->quadric(open);
            return use(quadric.placed());
        }
        const Sphere sphere = this->sphere(open);
        return use(&std::as_const(sphere));
    }

    /// Around all of its way.
    Box bounds() const;
    /// Distance by which rays must leave it beside that of its size, m: what its way rounds.
    float rounding() const;

private:
    const ShapeGeometry& first_;
    std::span<const ShapeGeometry> later_;
};

}  // namespace lightnet
