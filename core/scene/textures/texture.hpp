// Textures as read from files: what covers a surface.
#pragma once

#include <cstdint>
#include <memory>
#include <variant>

#include "core/base/math/rgb.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/textures/image.hpp"

namespace lightnet {

/// Index into SceneData::textures.
using TextureId = std::uint32_t;

enum class Wrap { repeat, mirror, clamp, black };

/// uv × scale, turned by `turn` (radians, anticlockwise), + offset.
struct UvTransform {
    Vec2 scale{1, 1}, offset{0, 0};
    float turn = 0;
    friend bool operator==(const UvTransform&, const UvTransform&) = default;
};

/// An image over texture coordinates: (0, 0) is its lower left corner, (1, 1) its upper right one.
struct ImageTexture {
    std::shared_ptr<const Image> image{};  // shared by all textures of one file
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
    UvTransform uv{};
    enum class Channel { colour, mean, red, green, blue, alpha } channel = Channel::colour;  // one, or their mean: grey
    bool nearest = false;                                                                    // else bilinear
};
/// Squares of uv side 1, alternating: `even` where ⌊u⌋ + ⌊v⌋ is.
struct CheckerTexture {
    TextureId even = 0, odd = 0;
    UvTransform uv{};
};
/// The product of two.
struct ProductTexture {
    TextureId first = 0, second = 0;
};
/// first × (1 - amount) + second × amount.
struct MixTexture {
    TextureId first = 0, second = 0, amount = 0;
};
/// The colours of the mesh's vertices; white where it has none.
struct VertexColour {};

/// A colour (or a number, then a grey) over a surface: `scale` × what the pattern says, then 1 - that if inverted.
/// Values below 0 count as 0. May name textures that stand before it only.
struct Texture {
    Rgb scale{1, 1, 1};
    std::variant<std::monostate, ImageTexture, CheckerTexture, ProductTexture, MixTexture, VertexColour> pattern;
    bool invert = false;
};

}  // namespace lightnet
