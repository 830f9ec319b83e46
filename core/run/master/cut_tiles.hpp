// Tiles that are rendered in pieces, as a whole one would take long.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "core/base/math/rgb.hpp"
#include "core/film/tile.hpp"

namespace lightnet {

/// Cuts tiles into smaller rectangles, and puts their pixels together again: who takes in a picture sees whole tiles
/// only. Pixels do not depend on the tile that they are rendered in. One thread's.
class CutTiles {
public:
    struct Whole {
        Tile tile;
        std::vector<Rgb> pixels;  // row by row, the colours of each side by side
    };

    /// Pieces of at most about so many pixels, and never below 8 by 8; only the tile itself where it is no larger.
    /// Until all of them are put together, they are known as its pieces.
    std::vector<Tile> cut(const Tile& tile, std::size_t pixels);
    /// A piece of a tile that was cut.
    bool is_piece(const Tile& tile) const { return parts_.contains(key_of(tile)); }
    /// Takes in the pixels of a piece, once. The whole tile, when it was the last that was missing.
    std::optional<Whole> put(const Tile& piece, std::span<const Rgb> pixels);

private:
    struct Part {
        Whole whole;
        std::size_t missing = 0;  // pieces
    };
    using Key = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>;
    static Key key_of(const Tile& tile) { return {tile.first_sample, tile.y, tile.x}; }

    std::map<Key, std::shared_ptr<Part>> parts_;  // by piece
};

}  // namespace lightnet
