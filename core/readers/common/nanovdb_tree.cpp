#include "core/readers/common/nanovdb_tree.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "core/readers/common/inverse.hpp"

namespace lightnet::nanovdb {
namespace {

using Place = std::array<std::int64_t, 3>;  // of a point, in steps of the grid

constexpr std::int64_t side = VolumeGrid::block_side;

// Where things lie in a grid of floats (NanoVDB.h and PNanoVDB.h of version 32).
constexpr std::uint64_t map_at = 296, tree_at = 672;
struct Level {
    std::uint64_t size, active, child, table;  // bytes; masks and table from the start of a node
    std::uint32_t bits;                        // of a place along an axis: how many of its parts a node has
    std::uint32_t shift;                       // and how many points each of them is wide, as a power of two
};
constexpr Level upper{270400, 32, 4128, 8256, 5, 7}, lower{33856, 32, 544, 1088, 4, 3};
constexpr std::uint64_t leaf_size = 2144, leaf_active = 16, leaf_values = 96;
constexpr std::uint64_t root_size = 64, root_tile_size = 32;

/// A cube of one value.
struct Tile {
    Place origin;
    std::int64_t wide;
    float value;
};
struct Leaf {
    Place origin;
    std::uint64_t at;
};
/// Points that say something.
struct Span {
    Place low{std::numeric_limits<std::int64_t>::max(), std::numeric_limits<std::int64_t>::max(),
              std::numeric_limits<std::int64_t>::max()};
    Place high{std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::min(),
               std::numeric_limits<std::int64_t>::min()};

    void add(const Place& first, const Place& last) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], first[axis]);
            high[axis] = std::max(high[axis], last[axis]);
        }
    }
    bool empty() const { return low[0] > high[0]; }
};

float sound_value(float value) {
    if (!std::isfinite(value)) refuse("a number is not finite");
    return std::max(value, 0.0f);
}

/// What is in a tree.
class Contents {
public:
    explicit Contents(const Checked& grid) : grid_(grid) { read_root(); }

    const Span& active() const { return active_; }
    const std::vector<Tile>& tiles() const { return tiles_; }
    const std::vector<Leaf>& leaves() const { return leaves_; }
    float background() const { return background_; }

private:
    bool bit(std::uint64_t mask, std::uint32_t n) const { return grid_.get<std::uint8_t>(mask + n / 8) >> (n % 8) & 1; }
    static Place moved(const Place& origin, std::uint32_t n, std::uint32_t bits, std::uint32_t shift) {
        const std::uint32_t most = (1u << bits) - 1;
        return {origin[0] + (std::int64_t{n >> (2 * bits)} << shift),
                origin[1] + (std::int64_t{n >> bits & most} << shift), origin[2] + (std::int64_t{n & most} << shift)};
    }
    /// Nodes lie one beside the other, so there are only so many.
    void count(std::uint64_t nodes, std::uint64_t size) const {
        if (nodes > grid_.size() / size) refuse("nodes of its tree lie on each other");
    }
    void add_tile(const Place& origin, std::int64_t wide, float value, bool active) {
        value = sound_value(value);
        if (active) active_.add(origin, {origin[0] + wide - 1, origin[1] + wide - 1, origin[2] + wide - 1});
        if (value != background_) tiles_.push_back({origin, wide, value});
    }

    void read_root() {
        const std::uint64_t root = tree_at + grid_.get<std::uint64_t>(tree_at + 24);
        const auto tiles = grid_.get<std::uint32_t>(root + 24);
        background_ = sound_value(grid_.get<float>(root + 28));
        grid_.part(root + root_size, tiles * root_tile_size);
        for (std::uint32_t n = 0; n < tiles; ++n) {
            const std::uint64_t tile = root + root_size + n * root_tile_size;
            const auto key = grid_.get<std::uint64_t>(tile), child = grid_.get<std::uint64_t>(tile + 8);
            const auto of_key = [&](int shift) {  // the upper 20 bits of a coordinate
                return std::int64_t{static_cast<std::int32_t>(static_cast<std::uint32_t>(key >> shift) << 12)};
            };
            const Place origin{of_key(42), of_key(21), of_key(0)};
            if (child)
                read_upper(origin, root + child);
            else
                add_tile(origin, 4096, grid_.get<float>(tile + 20), grid_.get<std::uint32_t>(tile + 16) != 0);
        }
    }
    void read_upper(const Place& origin, std::uint64_t node) {
        count(++uppers_, upper.size);
        each_part(upper, origin, node, [&](const Place& at, std::uint64_t child) { read_lower(at, child); });
    }
    void read_lower(const Place& origin, std::uint64_t node) {
        count(++lowers_, lower.size);
        each_part(lower, origin, node, [&](const Place& at, std::uint64_t child) { read_leaf(at, child); });
    }
    template <class Child>
    void each_part(const Level& level, const Place& origin, std::uint64_t node, const Child& on_child) {
        grid_.part(node, level.size);
        for (std::uint32_t n = 0; n < 1u << 3 * level.bits; ++n) {
            const Place at = moved(origin, n, level.bits, level.shift);
            const std::uint64_t entry = node + level.table + 8 * n;
            if (bit(node + level.child, n))
                on_child(at, node + grid_.get<std::uint64_t>(entry));
            else
                add_tile(at, std::int64_t{1} << level.shift, grid_.get<float>(entry), bit(node + level.active, n));
        }
    }
    void read_leaf(const Place& origin, std::uint64_t leaf) {
        grid_.part(leaf, leaf_size);
        leaves_.push_back({origin, leaf});
        count(leaves_.size(), leaf_size);
        for (std::uint32_t row = 0; row < 64; ++row) {  // of points along z
            const auto on = grid_.get<std::uint8_t>(leaf + leaf_active + row);
            if (!on) continue;
            const Place start{origin[0] + row / 8, origin[1] + row % 8, origin[2]};
            active_.add({start[0], start[1], start[2] + std::countr_zero(on)},
                        {start[0], start[1], start[2] + 7 - std::countl_zero(on)});
        }
    }

    const Checked& grid_;
    Span active_;
    std::vector<Tile> tiles_;
    std::vector<Leaf> leaves_;
    float background_ = 0;
    std::uint64_t uppers_ = 0, lowers_ = 0;
};

/// The grid of a tree, block by block.
class Blocks {
public:
    Blocks(const Checked& from, const Contents& contents) : from_(from) {
        set_box(contents.active());
        grid_.blocks.assign(std::size_t(count_[0] * count_[1] * count_[2]), constant(contents.background()));
        for (const Tile& tile : contents.tiles()) fill(tile);
        for (const Leaf& leaf : contents.leaves()) copy(leaf);
    }

    VolumeGrid take() { return std::move(grid_); }
    const Place& low() const { return low_; }

private:
    /// Blocks around all that is active, so that it fades over one step of the grid.
    void set_box(const Span& active) {
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
            refuse(fmt::format("its values lie in a box of {} x {} x {} points, which is more than can be held",
                               grid_.size[0], grid_.size[1], grid_.size[2]));
        grid_.fades = true;
    }
    std::uint32_t add_block() {
        grid_.values.resize(grid_.values.size() + VolumeGrid::block_points);
        return static_cast<std::uint32_t>(grid_.values.size() / VolumeGrid::block_points - 1);
    }
    /// The block that has that value everywhere.
    std::uint32_t constant(float value) {
        const auto [entry, fresh] = constants_.try_emplace(std::bit_cast<std::uint32_t>(value), 0);
        if (fresh) {
            // of each a block is made, which is larger than what the file says of it
            if (constants_.size() * VolumeGrid::block_points * sizeof(float) >
                (std::size_t{1} << 24) + 8 * from_.size())
                refuse("it has too many parts of one value each");
            entry->second = add_block();
            std::fill_n(values_in(entry->second), VolumeGrid::block_points, value);
        }
        return entry->second;
    }
    float* values_in(std::uint32_t block) {
        return grid_.values.data() + std::size_t{block} * VolumeGrid::block_points;
    }
    std::uint32_t& block_at(std::int64_t x, std::int64_t y, std::int64_t z) {
        return grid_.blocks[std::size_t((z * count_[1] + y) * count_[0] + x)];
    }

    void fill(const Tile& tile) {
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
                    if (++filled_ > grid_.blocks.size()) refuse("parts of its tree lie at the same place");
                    block_at(x, y, z) = block;
                }
    }
    void copy(const Leaf& leaf) {
        Place at;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            at[axis] = (leaf.origin[axis] - low_[axis]) / side;
            if (leaf.origin[axis] < low_[axis] || at[axis] >= count_[axis]) return;  // nothing in it is active
        }
        const std::uint32_t block = add_block();
        block_at(at[0], at[1], at[2]) = block;
        std::array<float, VolumeGrid::block_points> found;  // z fastest
        std::memcpy(found.data(), from_.part(leaf.at + leaf_values, sizeof found).data(), sizeof found);
        float* to = values_in(block);
        for (std::size_t z = 0; z < 8; ++z)
            for (std::size_t y = 0; y < 8; ++y)
                for (std::size_t x = 0; x < 8; ++x) *to++ = sound_value(found[x << 6 | y << 3 | z]);
    }

    const Checked& from_;
    VolumeGrid grid_;
    Place low_{}, count_{};  // the first point, and how many blocks there are
    std::map<std::uint32_t, std::uint32_t> constants_;
    std::size_t filled_ = 0;
};

/// From steps of the grid to the file's world.
Matrix map_of(const Checked& grid) {
    Matrix map;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) map.m[i][j] = grid.get<double>(map_at + 88 + 8 * (3 * i + j));
        map.m[i][3] = grid.get<double>(map_at + 232 + 8 * i);
    }
    for (const auto& row : map.m)
        for (const double number : row)
            if (!std::isfinite(number)) refuse("its transform is not finite");
    return map;
}

}  // namespace

NanovdbGrid tree_in(const Checked& grid) {
    const auto from_world = inverse(map_of(grid));
    if (!from_world) refuse("its transform is singular");
    const Contents contents(grid);
    Blocks blocks(grid, contents);
    const Place low = blocks.low();
    auto made = std::make_shared<VolumeGrid>(blocks.take());
    Matrix to_cube;  // a point lies in the middle of its cell
    for (std::size_t axis = 0; axis < 3; ++axis) {
        to_cube.m[axis][axis] = 1 / double(made->size[axis]);
        to_cube.m[axis][3] = (0.5 - double(low[axis])) / double(made->size[axis]);
    }
    return {std::move(made), to_cube * *from_world};
}

}  // namespace lightnet::nanovdb
