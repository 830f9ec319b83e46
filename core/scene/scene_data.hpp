// A scene as read from files: plain data, before anything is built from it. Readers write it, Scene consumes it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/error.hpp"
#include "core/math/rgb.hpp"
#include "core/math/transform.hpp"
#include "core/math/vec.hpp"

namespace lightnet {

/// A decoded picture, linear, row 0 on top.
struct Image {
    std::uint32_t width = 0, height = 0;
    std::vector<Rgb> pixels;
    std::vector<float> alpha;  // empty: opaque
};

enum class Wrap { repeat, clamp, black };

/// A colour over the surface: constant, or an image looked up by texture coordinates (bilinear) times a scale. (0, 0)
/// is the image's lower left corner, (1, 1) its upper right one. Values below 0 count as 0.
struct Texture {
    Rgb scale{1, 1, 1};                  // the colour itself when there is no image
    std::shared_ptr<const Image> image;  // shared by all textures of one file
    Wrap wrap = Wrap::repeat;
    bool invert = false;                   // 1 - scale × image instead
    Vec2 uv_scale{1, 1}, uv_offset{0, 0};  // looked up at uv × scale + offset
};

/// Index into SceneData::textures.
using TextureId = std::uint32_t;

/// What a material is made of. Roughness is the GGX α (already remapped if the file asks for it).
struct DiffuseMaterial {
    TextureId reflectance = 0;
};
struct ConductorMaterial {
    TextureId eta = 0, k = 0;              // complex index of refraction per channel
    std::optional<TextureId> reflectance;  // given instead of eta and k
    float alpha_u = 0, alpha_v = 0;        // 0: smooth
};
struct DielectricMaterial {
    float eta = 1.5f;  // inside over outside (outside: where the normal points)
    float alpha_u = 0, alpha_v = 0;
};
struct ThinDielectricMaterial {
    float eta = 1.5f;
};
/// A diffuse base under a dielectric coat.
struct CoatedDiffuseMaterial {
    TextureId reflectance = 0;
    float eta = 1.5f;
    float alpha_u = 0, alpha_v = 0;
};
struct Material {
    std::string name;  // as in the file; may be empty
    std::variant<DiffuseMaterial, ConductorMaterial, DielectricMaterial, ThinDielectricMaterial, CoatedDiffuseMaterial>
        model;
};

/// Emission of a shape: radiance in W·sr⁻¹·m⁻² on the side of its normal, or on both.
struct AreaEmission {
    Rgb radiance;
    bool two_sided = false;
};

struct Mesh {
    std::vector<Vec3> positions;  // world space
    std::vector<Vec3> normals;    // shading normals per vertex, or empty
    std::vector<Vec2> uvs;        // per vertex, or empty
    std::vector<std::array<std::uint32_t, 3>> triangles;
    bool flip_normals = false;  // geometric normal against the order of vertices; with shading normals
                                // a reader orders them so that both lie on the same side
};

struct Sphere {
    Vec3 center;
    float radius = 1;           // metres
    bool flip_normals = false;  // normal inwards
    Matrix to_world;            // its own axes, for texture coordinates: orthonormal, nothing moved
};

struct Shape {
    std::variant<Mesh, Sphere> geometry;
    std::uint32_t material = 0;  // index into SceneData::materials
    std::optional<AreaEmission> emission;
    SourceLine where;
};

/// A thin pinhole camera. Right-handed picture: x to the right, y down in the picture.
struct CameraData {
    Matrix to_world;  // camera space: looks along +z, y up, x to the right of the picture
    float fov = 90;   // degrees, across the shorter side of the picture
    std::array<float, 4> screen{-1, 1, -1,
                                1};  // x min, x max, y min, y max at distance 1/tan(fov/2), shorter side = ±1
    bool screen_given = false;       // else derived from the picture's shape
};

struct FilmData {
    std::uint32_t width = 512, height = 512;
    float scale = 1;  // of all radiances: imaging ratio × exposure
    std::array<float, 4> crop{0, 1, 0, 1};
};

/// A constant environment, W·sr⁻¹·m⁻².
struct EnvironmentData {
    Rgb radiance;
};

struct SceneData {
    std::vector<Shape> shapes;
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<EnvironmentData> environments;
    CameraData camera;
    FilmData film;
    std::vector<Problem> warnings;  // what was read, but not taken literally
};

}  // namespace lightnet
