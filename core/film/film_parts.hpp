// The rectangles of a film's tiling, and the blocks that they have.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "core/base/math/rgb.hpp"
#include "core/film/addition.hpp"
#include "core/film/film_state.hpp"
#include "core/film/film_tiling.hpp"
#include "core/film/tile.hpp"
#include "core/film/window.hpp"

namespace lightnet {

/// One rectangle: its first blocks are in the sums of the film, and others wait.
struct FilmPart {
    std::uint32_t next_block = 0;  // the first one that is not in the sums
    FilmState::Waiting waiting;
    bool done = false;   // needs no further block
    bool ended = false;  // by a round

    bool has(std::uint32_t block) const;
    /// Those that have come one behind the other, whether their group is whole or not.
    std::uint32_t blocks_shown() const;
    /// Behind the last one that is there.
    std::uint32_t blocks_begun() const;
    /// The sum of the blocks that are shown and that are not in the sums of the film, in their order: what a picture
    /// that ends with them has for its last group. Empty: there is none.
    std::vector<Rgb> begun_group(const Addition& addition) const;
};

/// All of them that were seen, in the order of their place.
class FilmParts {
public:
    explicit FilmParts(const FilmTiling& tiling) : taken_(tiling.window().pixels()) {}

    /// Null: it was not seen.
    const FilmPart* find(const Window& area) const;
    /// Makes it, if need be. Throws Error where it overlaps another: their samples would be added twice.
    FilmPart& claim(const Window& area, const FilmTiling& tiling);
    bool has(const Tile& tile) const;
    /// No pixel is left that lies in none.
    bool everywhere() const;

    bool empty() const { return parts_.empty(); }
    auto begin() { return parts_.begin(); }
    auto end() { return parts_.end(); }
    auto begin() const { return parts_.begin(); }
    auto end() const { return parts_.end(); }

    /// Blocks that all pixels have, and nothing beyond waits; none: they differ, or have none.
    std::optional<std::uint32_t> even_blocks() const;

private:
    struct ByPlace {
        bool operator()(const Window& a, const Window& b) const {
            return std::tie(a.x, a.y, a.width, a.height) < std::tie(b.x, b.y, b.width, b.height);
        }
    };
    std::vector<bool> taken_;  // per pixel: it lies in one of them
    std::map<Window, FilmPart, ByPlace> parts_;
};

/// The pixels of a tile.
inline Window area_of(const Tile& tile) { return {tile.x, tile.y, tile.width, tile.height}; }

}  // namespace lightnet
