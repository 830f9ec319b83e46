#include "core/readers/common/sparse_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "core/base/error.hpp"
#include "core/readers/common/inverse.hpp"

namespace lightnet::sparse {
namespace {

constexpr std::int64_t side = VolumeGrid::block_side;

}  // namespace

float sound_value(float value) {
    if (!std::isfinite(value)) throw Error("a number is not finite");
    return std::max(value, 0.0f);
}

Place part_of(const Place& origin, std::uint32_t n, std::uint32_t bits, std::uint32_t shift) {
    const std::uint32_t most = (1u << bits) - 1;
    return {origin[0] + (std::int64_t{n >> (2 * bits)} << shift), origin[1] + (std::int64_t{n >> bits & most} << shift),
            origin[2] + (std::int64_t{n & most} << shift)};
}

void Span::add(const Place& first, const Place& last) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], first[axis]);
        high[axis] = std::max(high[axis], last[axis]);
    }
}

void Span::add_leaf(const Place& origin, std::span<const std::byte, 64> active) {
    for (std::uint32_t row = 0; row < 64; ++row) {
        const auto on = std::to_integer<std::uint8_t>(active[row]);
        if (!on) continue;
        const Place start{origin[0] + row / 8, origin[1] + row % 8, origin[2]};
        add({start[0], start[1], start[2] + std::countr_zero(on)},
            {start[0], start[1], start[2] + 7 - std::countl_zero(on)});
    }
}

// One step of the grid more on each side, over which it fades.
Blocks::Blocks(const Span& active, float background, std::size_t file_size) : file_size_(file_size) {
    constexpr double most = 1 << 24;
    double all = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto floored = [](std::int64_t at) { return (at >= 0 ? at : at - side + 1) / side; };
        const std::int64_t first = active.empty() ? 0 : floored(active.low[axis] - 1),
                           last = active.empty() ? 0 : floored(active.high[axis] + 1);
        low_[axis] = first * side, count_[axis] = last - first + 1;
        grid_.size[axis] = static_cast<std::uint32_t>(count_[axis] * side);
        all *= double(count_[axis]);
    }
    if (all > most)
        throw Error(fmt::format("its values lie in a box of {} x {} x {} points, which is more than can be held",
                                grid_.size[0], grid_.size[1], grid_.size[2]));
    grid_.fades = true;
    grid_.blocks.assign(std::size_t(count_[0] * count_[1] * count_[2]), constant(background));
}

std::uint32_t Blocks::add_block() {
    grid_.values.resize(grid_.values.size() + VolumeGrid::block_points);
    return static_cast<std::uint32_t>(grid_.values.size() / VolumeGrid::block_points - 1);
}

std::uint32_t Blocks::constant(float value) {
    const auto [entry, fresh] = constants_.try_emplace(std::bit_cast<std::uint32_t>(value), 0);
    if (fresh) {
        // of each a block is made, which is larger than what the file says of it
        if (constants_.size() * VolumeGrid::block_points * sizeof(float) > (std::size_t{1} << 24) + 8 * file_size_)
            throw Error("it has too many parts of one value each");
        entry->second = add_block();
        std::fill_n(values_in(entry->second), VolumeGrid::block_points, value);
    }
    return entry->second;
}

float* Blocks::values_in(std::uint32_t block) {
    return grid_.values.data() + std::size_t{block} * VolumeGrid::block_points;
}

std::uint32_t& Blocks::block_at(const Place& at) {
    return grid_.blocks[std::size_t((at[2] * count_[1] + at[1]) * count_[0] + at[0])];
}

void Blocks::fill(const Tile& tile) {
    Place first, last;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        first[axis] = std::max<std::int64_t>((tile.origin[axis] - low_[axis]) / side, 0);
        last[axis] = std::min((tile.origin[axis] + tile.wide - low_[axis]) / side, count_[axis]) - 1;
        if (tile.origin[axis] + tile.wide <= low_[axis] || first[axis] > last[axis]) return;
    }
    const std::uint32_t block = constant(tile.value);
    for (std::int64_t z = first[2]; z <= last[2]; ++z)
        for (std::int64_t y = first[1]; y <= last[1]; ++y)
            for (std::int64_t x = first[0]; x <= last[0]; ++x) {
                if (++filled_ > grid_.blocks.size()) throw Error("parts of its tree lie at the same place");
                block_at({x, y, z}) = block;
            }
}

void Blocks::copy(const Place& origin, LeafValues values) {
    Place at;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        at[axis] = (origin[axis] - low_[axis]) / side;
        if (origin[axis] < low_[axis] || at[axis] >= count_[axis]) return;  // nothing in it is active
    }
    const std::uint32_t block = add_block();
    block_at(at) = block;
    float* to = values_in(block);
    for (std::size_t z = 0; z < 8; ++z)
        for (std::size_t y = 0; y < 8; ++y)
            for (std::size_t x = 0; x < 8; ++x) *to++ = sound_value(values[x << 6 | y << 3 | z]);
}

SparseGrid Blocks::take(const Matrix& to_world) {
    for (const auto& row : to_world.m)
        for (const double number : row)
            if (!std::isfinite(number)) throw Error("its transform is not finite");
    const auto from_world = inverse(to_world);
    if (!from_world) throw Error("its transform is singular");
    Matrix to_cube;  // a point lies in the middle of its cell
    for (std::size_t axis = 0; axis < 3; ++axis) {
        to_cube.m[axis][axis] = 1 / double(grid_.size[axis]);
        to_cube.m[axis][3] = (0.5 - double(low_[axis])) / double(grid_.size[axis]);
    }
    return {std::make_shared<const VolumeGrid>(std::move(grid_)), to_cube * *from_world};
}

}  // namespace lightnet::sparse
