// The tiling of a film: how its picture is cut into rectangles, and their samples into blocks and groups.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/film/film_format.hpp"
#include "core/film/tile.hpp"
#include "core/film/window.hpp"

namespace lightnet {

/// Rules of one format; constant. Where cells decide when they have samples enough, a group is one block.
class FilmTiling {
public:
    explicit FilmTiling(const FilmFormat& format);

    /// What is rendered.
    const Window& window() const { return window_; }
    /// Of samples, that a pixel has at most.
    std::uint32_t blocks() const { return blocks_; }
    /// Of so many blocks.
    std::uint32_t samples_in(std::uint32_t blocks) const;
    /// The place of a pixel of the picture in what is rendered.
    std::size_t index(std::uint32_t x, std::uint32_t y) const {
        return std::size_t{y - window_.y} * window_.width + (x - window_.x);
    }

    Blocks group_of(std::uint32_t block) const;
    Blocks handed_out(std::uint32_t block) const;
    /// It lacks blocks that it has in a picture of more samples, or its last block is short.
    bool is_open(const Blocks& group) const;
    /// The tile has all that is handed out together.
    bool is_whole(const Tile& tile) const;
    /// The tile is complete for these blocks, and a film may add them.
    bool comes_next(std::uint32_t block, std::uint32_t blocks) const;
    /// One block of these pixels.
    Tile block_of(const Window& area, std::uint32_t block) const;
    /// The tile, or where cells decide its cells.
    std::vector<Tile> areas_of(const Tile& tile) const;
    /// Throws Error on a tile that is none of this picture's, or doesn't come with so many colours.
    void expect_valid(const Tile& tile, std::size_t colours) const;

private:
    Window window_;
    std::uint32_t samples_, blocks_;
    std::size_t colours_;  // of a pixel
    bool adaptive_, coarse_;
};

}  // namespace lightnet
