// A scene as read from files: plain data, before anything is built from it. Readers write it, Scene consumes it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/math/rgb.hpp"
#include "core/base/math/transform.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/data/image.hpp"

namespace lightnet {

/// Index into SceneData::textures.
using TextureId = std::uint32_t;
/// Index into SceneData::materials.
using MaterialId = std::uint32_t;

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

/// Roughness of a surface's facets along its two tangents.
struct Roughness {
    float u = 0, v = 0;                                             // 0: smooth
    std::optional<TextureId> texture{};                             // times this
    enum class Means { alpha, root, square } means = Means::alpha;  // GGX α = value, √value (pbrt), value² (glTF)
};

/// Index of refraction of a metal per colour, or how much it reflects head-on.
struct Metal {
    TextureId eta = 0, k = 0;
    std::optional<TextureId> reflectance{};  // given instead of eta and k
};

/// Reflects evenly; rough in the sense of Oren and Nayar where sigma > 0. Lets light through evenly, too, where a
/// transmittance is given.
struct DiffuseMaterial {
    TextureId reflectance = 0;
    float sigma = 0;  // standard deviation of the facets' slopes, radians
    std::optional<TextureId> transmittance{};
};
struct ConductorMaterial {
    Metal metal{};
    Roughness roughness{};
    std::optional<TextureId> tint{};  // times this
};
struct DielectricMaterial {
    float eta = 1.5f;  // inside over outside (outside: where the normal points)
    Roughness roughness{};
    std::optional<TextureId> reflected{}, transmitted{};  // not physical, but in files: tints
    bool thin = false;                                    // a pane: what enters leaves on the other side, undeflected
};
/// What becomes of light within a coat.
struct CoatLayer {
    float thickness = 0;        // of light straight through, exp(-thickness) is left
    std::uint32_t bounces = 0;  // off the base, that count; 0: all
};
/// A diffuse base under a dielectric coat.
struct CoatedDiffuseMaterial {
    TextureId reflectance = 0;  // of the base
    float eta = 1.5f;
    Roughness roughness{};            // of the coat
    std::optional<TextureId> tint{};  // not physical, but in files: times the coat's reflection
    bool base_colours_repeat = true;  // light that goes back and forth below the coat takes the base's colour each time
    CoatLayer layer{};
};
/// A metal under a dielectric coat.
struct CoatedConductorMaterial {
    Metal metal{};
    Roughness roughness{};  // of the metal
    float coat_eta = 1.5f;  // over air; the metal's index is over air, too
    Roughness coat{};
    CoatLayer layer{};
};
/// The principled model of Burley (2012, 2015), of which glTF's metallic-roughness model with its extensions is a part.
/// Numbers are 0 … 1 where nothing else is said; a texture multiplies.
struct PrincipledMaterial {
    TextureId base_colour = 0;
    float metallic = 0, transmission = 0;
    std::optional<TextureId> metallic_texture{}, transmission_texture{};
    Roughness roughness{0.5f, 0.5f, {}, Roughness::Means::square};
    float eta = 1.5f;
    float specular = 1;            // times the dielectric reflection
    Rgb specular_colour{1, 1, 1};  // of it, head-on; may exceed 1
    std::optional<TextureId> specular_texture{}, specular_colour_texture{};
    float sheen = 0, sheen_roughness = 0.3f;
    Rgb sheen_colour{1, 1, 1};
    std::optional<TextureId> sheen_texture{}, sheen_roughness_texture{};  // the first has colours
    float clearcoat = 0;
    std::optional<TextureId> clearcoat_texture{};
    Roughness clearcoat_roughness{0.03f, 0.03f, {}, Roughness::Means::square};
    bool thin = true;  // of transmission: a pane rather than a solid
};
/// `first` or `second`, the latter with a share of `amount`. They may be mixtures, but must not lead back here.
struct MixtureMaterial {
    MaterialId first = 0, second = 0;
    TextureId amount = 0;
};
/// One on the side of the normal, another behind; both opaque.
struct TwoFacedMaterial {
    MaterialId front = 0, back = 0;
};
/// Not there: light goes straight through (a border between media, say).
struct NoMaterial {};

struct Material {
    std::string name;  // as in the file; may be empty
    std::variant<DiffuseMaterial, ConductorMaterial, DielectricMaterial, CoatedDiffuseMaterial, CoatedConductorMaterial,
                 PrincipledMaterial, MixtureMaterial, TwoFacedMaterial, NoMaterial>
        model;
    bool one_sided = false;                 // black from behind (opaque models only)
    std::optional<TextureId> opacity{};     // share of the light that meets the surface at all; its red counts
    float opacity_cutoff = 0;               // > 0: there where opacity ≥ this, else not
    std::optional<TextureId> normal_map{};  // linear, 0.5 is 0; x along ∂p/∂u, y along ∂p/∂v, z along the normal
    float normal_scale = 1;                 // of its x and y
    std::optional<TextureId> bump_map{};    // height, metres, in the normal's direction; its red counts
    Rgb absorption{};  // per metre inside a solid dielectric (glTF's attenuation, Beer and Lambert's law)
};

/// Emission of a shape: radiance in W·sr⁻¹·m⁻² on the side of its normal, or on both.
struct AreaEmission {
    Rgb radiance;
    bool two_sided = false;
    std::optional<TextureId> texture{};  // times this
};

struct Mesh {
    std::vector<Vec3> positions;  // world space
    std::vector<Vec3> normals;    // shading normals per vertex, or empty
    std::vector<Vec2> uvs;        // per vertex, or empty
    std::vector<Rgb> colours;     // per vertex, linear, or empty
    std::vector<std::array<std::uint32_t, 3>> triangles;
    bool flip_normals = false;  // geometric normal against the order of vertices; with shading normals
                                // a reader orders them so that both lie on the same side
};

struct Sphere {
    Vec3 center;
    float radius = 1;           // metres
    bool flip_normals = false;  // normal inwards
    Matrix to_world{};          // its own axes, for texture coordinates: orthonormal, nothing moved
};

struct Shape {
    std::variant<Mesh, Sphere> geometry;
    MaterialId material = 0;
    std::optional<AreaEmission> emission{};
    SourceLine where;
    std::string name{};  // as in the file, or that of its own file; may be empty
};

/// Shapes that stand in the scene only through instances of them.
struct Object {
    std::string name;
    std::vector<std::uint32_t> shapes;  // indices into SceneData::shapes; none of them emits light
};
struct Instance {
    std::uint32_t object = 0;  // index into SceneData::objects
    Matrix to_world{};         // from the object's space, in which its shapes are given: affine, not singular
};

/// Right-handed picture: x to the right, y down in the picture.
struct CameraData {
    Matrix to_world{};  // camera space: looks along +z, y up, x to the right of the picture
    bool orthographic = false;
    float fov = 90;  // degrees, across the shorter side of the picture; of no use when orthographic
    std::array<float, 4> screen{-1, 1, -1, 1};  // x min, x max, y min, y max at distance 1/tan(fov/2), shorter side =
                                                // ±1; orthographic: in metres
    bool screen_given = false;                  // else derived from the picture's shape
    float lens_radius = 0;                      // metres; 0: a pinhole
    float focus_distance = 1e6f;                // metres along the axis to the plane in which everything is sharp
};

struct FilmData {
    std::uint32_t width = 512, height = 512;
    float scale = 1;  // of all radiances: imaging ratio × exposure
    std::array<float, 4> crop{0, 1, 0, 1};
};

/// Light from infinity: `radiance` (W·sr⁻¹·m⁻²), or an image times it.
struct EnvironmentData {
    Rgb radiance{1, 1, 1};
    std::shared_ptr<const Image> image{};
    enum class Layout { latitude_longitude, equal_area } layout = Layout::latitude_longitude;
    Matrix to_world{};  // a rotation. Latitude-longitude: +y is the top row, -z the picture's middle, +x right of it.
                        // Equal area: the octahedral map of Clarberg (2008) as pbrt lays it out: +z is the centre.
};

/// Lights without extent. World space.
struct PointLight {
    Vec3 position;
    Rgb intensity;  // W·sr⁻¹
};
/// Full intensity within `inner` of its axis, none beyond `outer` (radians), between them as `falloff` says.
struct SpotLight {
    Vec3 position, axis{0, 0, 1};  // axis: unit
    Rgb intensity;                 // W·sr⁻¹, on the axis
    float inner = 0, outer = 0;
    enum class Falloff { smoothstep, linear, squared_linear } falloff = Falloff::smoothstep;  // in cos, angle, cos
};
struct DirectionalLight {
    Vec3 direction{0, 0, -1};  // in which it shines, unit
    Rgb irradiance;            // W·m⁻², on a plane across it
};
using BareLight = std::variant<PointLight, SpotLight, DirectionalLight>;

struct SceneData {
    std::vector<Shape> shapes;  // those that no object names stand in world space
    std::vector<Object> objects;
    std::vector<Instance> instances;
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<EnvironmentData> environments;  // their radiances add up
    std::vector<BareLight> lights;              // that no ray can meet
    CameraData camera;
    bool camera_given = false;  // else Scene looks at everything from where all of it is seen
    FilmData film;
    std::vector<Problem> warnings;  // what was read, but not taken literally
};

}  // namespace lightnet
