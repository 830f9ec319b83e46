// Colours over surfaces.
#pragma once

#include <span>
#include <vector>

#include "core/base/math/rgb.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/textures/texture.hpp"
#include "core/scene/textures/vertex_values.hpp"

namespace lightnet {

/// What a texture may depend on.
struct TexturePlace {
    Vec2 uv;
    Rgb vertex_colour{1, 1, 1};
    // world space; only where depends_on_place() says so
    Vec3 position{};
    Vec3 normal{};               // geometric, unit
    BetweenVertices vertices{};  // of meshes whose vertices know more
};

/// The value of a texture at a place: bilinear, not filtered over an area. Coordinate v counts upwards from the
/// image's bottom row. May lie below 0, as heights do.
/// DECISIONS: textures-of-one-size
Rgb value_at(std::span<const Texture> textures, TextureId texture, const TexturePlace& place);
/// The value of a texture at a place, as a colour: never below 0.
Rgb look_up(std::span<const Texture> textures, TextureId texture, const TexturePlace& place);

/// Where in memory the numbers of a picture lie that look_up() will read first: null where it reads none. For who looks
/// up many: he fetches them all before he needs the first.
struct PictureLines {
    const void* upper = nullptr;
    const void* lower = nullptr;
};
PictureLines lines_of(const ImageTexture& texture, Vec2 uv);

/// Does the texture say the same everywhere?
bool is_constant(const Texture& texture);

/// Does its value follow from more of a place than texture coordinates and colours of vertices?
bool depends_on_place(std::span<const Texture> textures, TextureId texture);

/// The textures that a texture is made of.
std::vector<TextureId> inputs_of(const Texture& texture);

/// Throws Error unless every texture names only such as stand before it.
void check_textures(std::span<const Texture> textures);

}  // namespace lightnet
