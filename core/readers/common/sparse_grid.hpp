// Grids of floats of which only some parts say anything, as the files of OpenVDB and NanoVDB have them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <span>

#include "core/base/math/transform.hpp"
#include "core/scene/media/medium.hpp"

namespace lightnet {

/// Floats at points of space, in blocks, 0 where the file has none; what is below 0 there is 0.
struct SparseGrid {
    std::shared_ptr<const VolumeGrid> grid;
    Matrix to_grid;  // from the file's world to the grid's unit cube
};

namespace sparse {

using Place = std::array<std::int64_t, 3>;  // of a point, in steps of the grid

/// The value as media take it. Throws Error where it is not finite.
float sound_value(float value);

/// From one node of a tree to its part of that number. `bits`: of a place along an axis, how many of its parts a node
/// has; `shift`: how many points each of them is wide, as a power of two.
Place part_of(const Place& origin, std::uint32_t n, std::uint32_t bits, std::uint32_t shift);

/// Points that say something.
struct Span {
    Place low{std::numeric_limits<std::int64_t>::max(), std::numeric_limits<std::int64_t>::max(),
              std::numeric_limits<std::int64_t>::max()};
    Place high{std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::min(),
               std::numeric_limits<std::int64_t>::min()};

    void add(const Place& first, const Place& last);
    /// Those of a leaf at `origin` whose bits are set: 8 × 8 rows along z, y running quicker than x.
    void add_leaf(const Place& origin, std::span<const std::byte, 64> active);
    bool empty() const { return low[0] > high[0]; }
};

/// A cube of one value.
struct Tile {
    Place origin;
    std::int64_t wide;
    float value;
};

/// Numbers of a leaf as files have them: z runs fastest.
using LeafValues = std::span<const float, VolumeGrid::block_points>;

/// A tree's grid, block by block. Throws Error where it would take more than a multiple of its file.
class Blocks {
public:
    /// Blocks around all that is active. `file_size`: what is large, bytes.
    Blocks(const Span& active, float background, std::size_t file_size);
    void fill(const Tile& tile);
    void copy(const Place& origin, LeafValues values);
    /// `to_world`: from steps of the grid.
    SparseGrid take(const Matrix& to_world);

private:
    std::uint32_t add_block();
    /// The block that has that value everywhere.
    std::uint32_t constant(float value);
    float* values_in(std::uint32_t block);
    std::uint32_t& block_at(const Place& at);

    std::size_t file_size_;
    VolumeGrid grid_;
    Place low_{}, count_{};  // the first point, and how many blocks there are
    std::map<std::uint32_t, std::uint32_t> constants_;
    std::size_t filled_ = 0;
};

}  // namespace sparse
}  // namespace lightnet
