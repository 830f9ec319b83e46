// Textures as read from files: what covers a surface.
#pragma once

#include <cstdint>
#include <memory>
#include <type_traits>
#include <variant>

#include "core/base/index_of.hpp"
#include "core/base/math/rgb.hpp"
#include "core/base/math/transform.hpp"
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
    /// One of them, or their mean or luminance: grey.
    enum class Channel { colour, mean, red, green, blue, alpha, luminance } channel = Channel::colour;
    bool nearest = false;  // else bilinear
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

/// Another texture, laid over surfaces by where they are in the world, whatever their texture coordinates.
/// DECISIONS: places-instead-of-coordinates
struct ProjectedTexture {
    /// How places of the texture's own space become coordinates: x and y themselves; the angles from the z axis over π
    /// and around it over 2π; the angle around the z axis from -x over 2π, and z.
    enum class By { plane, sphere, cylinder };
    TextureId texture = 0;
    By by = By::plane;
    Matrix from_world{};  // into that space
};
void visit_members(Is<ProjectedTexture> auto& projected, const auto& visit) {
    auto& [texture, by, from_world] = projected;
    visit(texture, by, from_world);
}

/// Another texture, laid over meshes by further texture coordinates.
struct OtherUvTexture {
    TextureId texture = 0;
    std::uint32_t set = 0;  // 0: the second
};
void visit_members(Is<OtherUvTexture> auto& other, const auto& visit) {
    auto& [texture, set] = other;
    visit(texture, set);
}

/// Cubes of side 1 in a space of their own, alternating: `even` where ⌊x⌋ + ⌊y⌋ + ⌊z⌋ is.
struct CubesTexture {
    TextureId even = 0, odd = 0;
    Matrix from_world{};
};
void visit_members(Is<CubesTexture> auto& cubes, const auto& visit) {
    auto& [even, odd, from_world] = cubes;
    visit(even, odd, from_world);
}

/// Dots over texture coordinates, one in about two of five squares of side 1.
struct DotsTexture {
    TextureId dots = 0, around = 0;
    UvTransform uv{};
};
void visit_members(Is<DotsTexture> auto& pattern, const auto& visit) {
    auto& [dots, around, uv] = pattern;
    visit(dots, around, uv);
}

/// `along` where the surface's normal lies along a direction (unit), `across` where it lies across it; between, a mix
/// by the cosine.
struct DirectionTexture {
    TextureId along = 0, across = 0;
    Vec3 direction{0, 1, 0};
};
void visit_members(Is<DirectionTexture> auto& mix, const auto& visit) {
    auto& [along, across, direction] = mix;
    visit(along, across, direction);
}

/// Sums of noise in a space of its own: see noise.hpp.
struct NoiseTexture {
    enum class Kind { fractal, turbulence, wind } kind = Kind::fractal;
    std::int32_t octaves = 8;  // of wind: not used
    float roughness = 0.5f;    // the same: of an octave beside the one before
    Matrix from_world{};
};
void visit_members(Is<NoiseTexture> auto& noise, const auto& visit) {
    auto& [kind, octaves, roughness, from_world] = noise;
    visit(kind, octaves, roughness, from_world);
}

/// Veins across the y axis of a space of their own.
struct MarbleTexture {
    std::int32_t octaves = 8;
    float roughness = 0.5f;
    float variation = 0.2f;  // of the veins, by noise
    Matrix from_world{};
};
void visit_members(Is<MarbleTexture> auto& marble, const auto& visit) {
    auto& [octaves, roughness, variation, from_world] = marble;
    visit(octaves, roughness, variation, from_world);
}

/// One number for each colour of another texture, as grey.
struct GreyTexture {
    enum class By { luminance, mean };
    TextureId texture = 0;
    By by = By::luminance;
};
void visit_members(Is<GreyTexture> auto& grey, const auto& visit) {
    auto& [texture, by] = grey;
    visit(texture, by);
}

/// The colours of the mesh's vertices; white where it has none.
struct VertexColour {};
void visit_members(Is<VertexColour> auto&, const auto&) { static_assert(std::is_empty_v<VertexColour>); }

/// How much of a mesh is there, by its vertices, as grey; white where they don't say.
struct VertexAlpha {};
void visit_members(Is<VertexAlpha> auto&, const auto&) { static_assert(std::is_empty_v<VertexAlpha>); }

/// A colour (or a number, then a grey) over a surface: `scale` × what the pattern says, then 1 - that if inverted.
/// May name textures that stand before it only.
struct Texture {
    Rgb scale{1, 1, 1};
    std::variant<std::monostate, ImageTexture, CheckerTexture, ProductTexture, MixTexture, VertexColour,
                 ProjectedTexture, CubesTexture, DotsTexture, DirectionTexture, NoiseTexture, MarbleTexture,
                 OtherUvTexture, VertexAlpha, GreyTexture>
        pattern;
    bool invert = false;
};
void visit_members(Is<Texture> auto& texture, const auto& visit) {
    auto& [scale, pattern, invert] = texture;
    visit(scale, pattern, invert);
}

}  // namespace lightnet
