#include "core/readers/common/nanovdb_tree.hpp"

#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

namespace lightnet::nanovdb {
namespace {

using sparse::Place;

// Where things lie in a grid of floats (NanoVDB.h and PNanoVDB.h of version 32).
constexpr std::uint64_t map_at = 296, tree_at = 672;
struct Level {
    std::uint64_t size, active, child, table;  // bytes; masks and table from the start of a node
    std::uint32_t bits, shift;                 // see sparse::part_of()
};
constexpr Level upper{270400, 32, 4128, 8256, 5, 7}, lower{33856, 32, 544, 1088, 4, 3};
constexpr std::uint64_t leaf_size = 2144, leaf_active = 16, leaf_values = 96;
constexpr std::uint64_t root_size = 64, root_tile_size = 32;

struct Leaf {
    Place origin;
    std::uint64_t at;
};

/// What is in a tree.
class Contents {
public:
    explicit Contents(const Checked& grid) : grid_(grid) { read_root(); }

    const sparse::Span& active() const { return active_; }
    const std::vector<sparse::Tile>& tiles() const { return tiles_; }
    const std::vector<Leaf>& leaves() const { return leaves_; }
    float background() const { return background_; }

private:
    bool bit(std::uint64_t mask, std::uint32_t n) const { return grid_.get<std::uint8_t>(mask + n / 8) >> (n % 8) & 1; }
    /// Nodes lie one beside the other, so there are only so many.
    void count(std::uint64_t nodes, std::uint64_t size) const {
        if (nodes > grid_.size() / size) refuse("nodes of its tree lie on each other");
    }
    void add_tile(const Place& origin, std::int64_t wide, float value, bool active) {
        value = sparse::sound_value(value);
        if (active) active_.add(origin, {origin[0] + wide - 1, origin[1] + wide - 1, origin[2] + wide - 1});
        if (value != background_) tiles_.push_back({origin, wide, value});
    }

    void read_root() {
        const std::uint64_t root = tree_at + grid_.get<std::uint64_t>(tree_at + 24);
        const auto tiles = grid_.get<std::uint32_t>(root + 24);
        background_ = sparse::sound_value(grid_.get<float>(root + 28));
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
            const Place at = sparse::part_of(origin, n, level.bits, level.shift);
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
        active_.add_leaf(origin, grid_.part(leaf + leaf_active, 64).first<64>());
    }

    const Checked& grid_;
    sparse::Span active_;
    std::vector<sparse::Tile> tiles_;
    std::vector<Leaf> leaves_;
    float background_ = 0;
    std::uint64_t uppers_ = 0, lowers_ = 0;
};

/// From steps of the grid to the file's world.
Matrix map_of(const Checked& grid) {
    Matrix map;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) map.m[i][j] = grid.get<double>(map_at + 88 + 8 * (3 * i + j));
        map.m[i][3] = grid.get<double>(map_at + 232 + 8 * i);
    }
    return map;
}

}  // namespace

SparseGrid tree_in(const Checked& grid) {
    const Contents contents(grid);
    sparse::Blocks blocks(contents.active(), contents.background(), grid.size());
    for (const sparse::Tile& tile : contents.tiles()) blocks.fill(tile);
    for (const Leaf& leaf : contents.leaves()) {
        std::array<float, VolumeGrid::block_points> values;
        std::memcpy(values.data(), grid.part(leaf.at + leaf_values, sizeof values).data(), sizeof values);
        blocks.copy(leaf.origin, values);
    }
    return blocks.take(map_of(grid));
}

}  // namespace lightnet::nanovdb
