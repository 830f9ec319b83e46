// Textures as read from files: what covers a surface.
#pragma once

#include <cstdint>
#include <memory>
#include <type_traits>
#include <variant>

#include "core/base/index_of.hpp"
#include "core/base/math/rgb.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/textures/image.hpp"
#include "core/scene/textures/members.hpp"

namespace lightnet {

struct Texture;
/// Into SceneData::textures.
using TextureId = IndexOf<Texture>;

enum class Wrap { repeat, mirror, clamp, black };

/// uv × scale, turned by `turn` (radians, anticlockwise), + offset.
struct UvTransform {
    Vec2 scale{1, 1}, offset{0, 0};
    float turn = 0;
    friend bool operator==(const UvTransform&, const UvTransform&) = default;
};
void visit_members(Is<UvTransform> auto& uv, const auto& visit) {
    auto& [scale, offset, turn] = uv;
    visit(scale, offset, turn);
}

/// An image over texture coordinates: (0, 0) is its lower left corner, (1, 1) its upper right one.
struct ImageTexture {
    std::shared_ptr<const Image> image{};  // shared by all textures of one file
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
    UvTransform uv{};
    enum class Channel { colour, mean, red, green, blue, alpha } channel = Channel::colour;  // one, or their mean: grey
    bool nearest = false;                                                                    // else bilinear
};
void visit_members(Is<ImageTexture> auto& texture, const auto& visit) {
    auto& [image, wrap_u, wrap_v, uv, channel, nearest] = texture;
    visit(image, wrap_u, wrap_v, uv, channel, nearest);
}

/// Squares of uv side 1, alternating: `even` where ⌊u⌋ + ⌊v⌋ is.
struct CheckerTexture {
    TextureId even = 0, odd = 0;
    UvTransform uv{};
};
void visit_members(Is<CheckerTexture> auto& texture, const auto& visit) {
    auto& [even, odd, uv] = texture;
    visit(even, odd, uv);
}

/// The product of two.
struct ProductTexture {
    TextureId first = 0, second = 0;
};
void visit_members(Is<ProductTexture> auto& texture, const auto& visit) {
    auto& [first, second] = texture;
    visit(first, second);
}

/// first × (1 - amount) + second × amount.
struct MixTexture {
    TextureId first = 0, second = 0, amount = 0;
};
void visit_members(Is<MixTexture> auto& texture, const auto& visit) {
    auto& [first, second, amount] = texture;
    visit(first, second, amount);
}

/// The colours of the mesh's vertices; white where it has none.
struct VertexColour {};
void visit_members(Is<VertexColour> auto&, const auto&) { static_assert(std::is_empty_v<VertexColour>); }

/// A colour (or a number, then a grey) over a surface: `scale` × what the pattern says, then 1 - that if inverted.
/// Values below 0 count as 0. May name textures that stand before it only.
struct Texture {
    Rgb scale{1, 1, 1};
    std::variant<std::monostate, ImageTexture, CheckerTexture, ProductTexture, MixTexture, VertexColour> pattern;
    bool invert = false;
};
void visit_members(Is<Texture> auto& texture, const auto& visit) {
    auto& [scale, pattern, invert] = texture;
    visit(scale, pattern, invert);
}

}  // namespace lightnet
