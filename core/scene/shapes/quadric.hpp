// Disks, cylinders and spheres, in whole or in part, under any affine transform.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "core/base/math/box.hpp"
#include "core/base/math/transform.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/textures/members.hpp"

namespace lightnet {

class PlacedQuadric;

/// A shape: see IsShape for what its functions say, and PlacedQuadric for how its points are named. A round surface
/// that an affine transform may stretch, seen in its own space as a part of
///   disk: the unit disk at z = 0, from the radius `inner` on; its normal is +z
///   cylinder: that around the z axis of radius 1, for z in [0, 1]; its normal is outwards
///   sphere: that of radius 1, for z in [low, high]; its normal is outwards
/// and of each that within `turn` from +x towards +y.
struct Quadric {
    enum class Round { disk, cylinder, sphere } round = Round::disk;
    float inner = 0;           // of disks, below 1
    float low = -1, high = 1;  // of spheres
    float turn = 6.2831855f;   // radians, up to 2π
    bool flip_normals = false;
    Matrix to_world{};  // affine, not singular; normals stay on their side
    /// Texture coordinates, rows of factors for (a, b, 1). a: share of the turn. b: of a disk from its rim inwards, of
    /// a cylinder upwards, of a sphere by the angle upwards.
    std::array<std::array<float, 3>, 2> to_uv{{{1, 0, 0}, {0, 1, 0}}};

    static constexpr const char* names = "quadrics";
    static constexpr const char* part = "a part of it";
    std::uint64_t pieces() const { return 1; }
    std::string fault() const;
    void add_to(Box& box, const Matrix& by) const;
    float extent() const;
    float largest_piece() const { return 0; }
    double area() const;
    std::size_t memory() const { return sizeof(Quadric); }
    PlacedQuadric placed() const;
};
void visit_members(Is<Quadric> auto& quadric, const auto& visit) {
    auto& [round, inner, low, high, turn, flip_normals, to_world, to_uv] = quadric;
    visit(round, inner, low, high, turn, flip_normals, to_world, to_uv);
}

}  // namespace lightnet
