// Participating media as read from files: fog, smoke, fire.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/hash.hpp"
#include "core/base/math/rgb.hpp"
#include "core/base/math/transform.hpp"
#include "core/scene/bsdf/phase.hpp"
#include "core/scene/textures/members.hpp"

namespace lightnet {

/// Numbers at the points of a grid that fills a unit cube. Constant once it is made.
struct VolumeGrid {
    std::array<std::uint32_t, 3> size{1, 1, 1};  // x, y, z; each 1 at least
    std::uint32_t channels = 1;                  // 1, or 3: red, green, blue
    std::vector<float> values{};                 // channel by channel of each point; x runs fastest
    /// Empty: `values` are those of all points. Else the points are in cubes, of which alike ones may be one: for each
    /// cube, x fastest, which block of `values` it is. `size` is a multiple of a cube's side.
    std::vector<std::uint32_t> blocks{};
    bool fades = false;    // what lies half a cell beyond the outermost points counts as 0; else as these
    bool nearest = false;  // the nearest point's numbers; else linear between eight

    static constexpr std::uint32_t block_side = 8, block_points = block_side * block_side * block_side;

    std::size_t points() const { return std::size_t{size[0]} * size[1] * size[2]; }
    std::size_t memory() const { return values.size() * sizeof(float) + blocks.size() * sizeof(std::uint32_t); }
    /// Which block a point lies in, if there are blocks.
    std::uint32_t block_of(const std::array<std::uint32_t, 3>& at) const {
        const std::size_t wide = size[0] / block_side, high = size[1] / block_side;
        return blocks[(at[2] / block_side * high + at[1] / block_side) * wide + at[0] / block_side];
    }
    /// Of a point: in `values`, counted in points.
    std::size_t index_of(const std::array<std::uint32_t, 3>& at) const;
    Rgb point(std::int64_t x, std::int64_t y, std::int64_t z) const;
    /// At a place in the unit cube; outside of it what the nearest place there has.
    Rgb at(Vec3 place) const;
    /// Of all that it is.
    Hash content() const;
};

/// A colour in space: the same everywhere, or times a grid.
struct VolumeField {
    Rgb value;
    std::shared_ptr<const VolumeGrid> grid{};
    Matrix to_grid{};  // from world space to the grid's unit cube

    Rgb at(Vec3 position) const { return grid ? value * grid->at(transform_point(to_grid, position)) : value; }
};
void visit_members(Is<VolumeField> auto& field, const auto& visit) {
    auto& [value, grid, to_grid] = field;
    visit(value, grid, to_grid);
}

/// What collides with light in space. Where `extinction` has a grid the medium ends with the grid's cube.
struct Medium {
    std::string name{};
    VolumeField extinction{};  // collisions per metre: absorbed and scattered
    VolumeField albedo{};      // share of them that scatters; or, if `albedo_scatters`, scattering per metre
    bool albedo_scatters = false;
    VolumeField emission{};  // radiance that comes to a ray per metre, W·sr⁻¹·m⁻³
    PhaseFunction phase{};
    SourceLine where{};

    /// Why it can't be used; "": it can.
    std::string fault() const;
    bool is_even() const { return !extinction.grid && !albedo.grid && !emission.grid; }
    Rgb albedo_at(Vec3 position) const;
};
void visit_members(Is<Medium> auto& medium, const auto& visit) {
    auto& [name, extinction, albedo, albedo_scatters, emission, phase, where] = medium;
    visit(extinction, albedo, albedo_scatters, emission, phase);
}

}  // namespace lightnet
