// A sphere.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>

#include "core/base/math/box.hpp"
#include "core/base/math/moved_box.hpp"
#include "core/base/math/transform.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/textures/members.hpp"

namespace lightnet {

/// A shape: see IsShape for what its functions say. A point of it is named by its octahedral normal.
struct Sphere {
    Vec3 center;
    float radius = 1;           // metres
    bool flip_normals = false;  // normal inwards
    Matrix to_world{};          // its own axes, for texture coordinates: orthonormal, nothing moved

    static constexpr const char* names = "spheres";
    static constexpr const char* part = "a part of it";
    std::uint64_t pieces() const { return 1; }
    std::string fault() const { return ""; }
    void add_to(Box& box, const Matrix& by) const {
        const Vec3 reach{radius, radius, radius};
        add_moved(box, {center - reach, center + reach}, by);
    }
    float extent() const { return std::fabs(center.x) + std::fabs(center.y) + std::fabs(center.z) + std::fabs(radius); }
    float largest_piece() const { return 0; }
    double area() const { return 4 * std::numbers::pi * double{radius} * double{radius}; }
    std::size_t memory() const { return sizeof(Sphere); }
    const Sphere* placed() const { return this; }
};
void visit_members(Is<Sphere> auto& sphere, const auto& visit) {
    auto& [center, radius, flip_normals, to_world] = sphere;
    visit(center, radius, flip_normals, to_world);
}

}  // namespace lightnet
