// A renderer: turns tiles of the image into pixels.
#pragma once

#include <span>
#include <utility>

#include "core/base/math/rgb.hpp"
#include "core/film/addition.hpp"
#include "core/film/tile.hpp"

namespace lightnet {

/// Samples the image, finds what is seen, and asks its lighting input how bright it is. The rules of LightOp hold.
class Renderer {
public:
    virtual ~Renderer() = default;

    /// Writes the sums of a tile: for each pixel that is told (row by row) one colour per film layer, side by side.
    /// Blocks are added up in the order of their index. `pixels` comes zeroed.
    void render(const Tile& tile, std::span<Rgb> pixels) const;

protected:
    Renderer() = default;
    /// For those who are asked to show ids: how blocks are added up.
    explicit Renderer(Addition addition) : addition_(std::move(addition)) {}
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

private:
    /// Writes the sum, over the samples of the tile's one block, of what each pixel receives; layer 0 is the emission
    /// that the renderer sees itself, the others are those of its lighting input. `pixels` comes zeroed. Each sample's
    /// radiance is added in the order of samples.
    virtual void render_block(const Tile& tile, std::span<Rgb> pixels) const = 0;

    Addition addition_;
};

}  // namespace lightnet
