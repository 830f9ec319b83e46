// A scene as read from files: plain data, before anything is built from it. Readers write it, Scene consumes it.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/math/rgb.hpp"
#include "core/base/math/transform.hpp"
#include "core/base/math/vec.hpp"
#include "core/base/query.hpp"
#include "core/scene/bsdf/material.hpp"
#include "core/scene/camera/camera_data.hpp"
#include "core/scene/media/medium.hpp"
#include "core/scene/shapes/shape.hpp"
#include "core/scene/textures/texture.hpp"

namespace lightnet {

/// What a lamp is known by: nothing of what shines.
struct LampLabel {
    std::string name{};       // as in the file; may be empty: see lamps_of()
    std::uint32_t group = 0;  // index into SceneData::groups
};

/// Emission of a shape: radiance in W·sr⁻¹·m⁻² on the side of its normal, or on both.
struct AreaEmission {
    Rgb radiance;
    bool two_sided = false;
    std::optional<TextureId> texture{};  // times this
    LampLabel label{};
    bool unseen = false;  // no ray meets it, whatever its material: it shines, and is not there
};
void visit_members(Is<AreaEmission> auto& emission, const auto& visit) {
    auto& [radiance, two_sided, texture, label, unseen] = emission;
    visit(radiance, two_sided, texture, unseen);
}

/// Of which medium the space on both sides of a shape is full: indices into SceneData::media.
struct MediumSides {
    std::uint16_t inside = Query::no_medium;   // against its normal
    std::uint16_t outside = Query::no_medium;  // where its normal points
};
void visit_members(Is<MediumSides> auto& sides, const auto& visit) {
    auto& [inside, outside] = sides;
    visit(inside, outside);
}

struct Shape {
    ShapeGeometry geometry;
    MaterialId material = 0;
    std::optional<AreaEmission> emission{};
    SourceLine where;
    std::string name{};                  // as in the file, or that of its own file; may be empty
    std::optional<MediumSides> media{};  // none: it parts no media
    std::string node_name{};             // of what stands there, where a file names that apart from its mesh; else ""
};
void visit_members(Is<Shape> auto& shape, const auto& visit) {
    auto& [geometry, material, emission, where, name, media, node_name] = shape;
    visit(geometry, material, emission, media);
}

/// Shapes that stand in the scene only through instances of them.
struct Object {
    std::string name;
    std::vector<std::uint32_t> shapes;  // indices into SceneData::shapes; none of them emits light
};
void visit_members(Is<Object> auto& object, const auto& visit) {
    auto& [name, shapes] = object;
    visit(shapes);
}

struct Instance {
    std::uint32_t object = 0;  // index into SceneData::objects
    Matrix to_world{};         // from the object's space, in which its shapes are given: affine, not singular
    std::string node_name{};   // as of a shape
};
void visit_members(Is<Instance> auto& instance, const auto& visit) {
    auto& [object, to_world, node_name] = instance;
    visit(object, to_world);
}

struct FilmData {
    std::uint32_t width = 512, height = 512;
    float scale = 1;  // of all radiances: imaging ratio × exposure
    std::array<float, 4> crop{0, 1, 0, 1};
};

/// One of several cameras of a file, and the shape of its pictures.
struct SceneCamera {
    std::string name{};  // as in the file; may be empty
    CameraData camera;
    FilmData film;
};

/// Who looks at a scene, and how its picture is taken.
struct Onlooker {
    CameraData camera;
    bool given = false;  // by somebody; else it is found when the scene is built
    FilmData film;
};

/// A motion that a file holds, for some time.
struct SceneAnimation {
    std::string name{};  // as in the file; may be empty
    double seconds = 0;  // until it has come to its end
};

/// When a shutter is open, in seconds of the scene's own time.
struct ShutterSpan {
    double open = 0, close = 0;
};

/// One of the ways in which a file dresses what is in it.
struct SceneVariant {
    std::string name{};
    bool shown = false;  // else the file's own materials are, or another's
};

/// Light from infinity: `radiance` (W·sr⁻¹·m⁻²), or an image times it.
/// A rectangle in world space through which light from infinity comes, and nowhere else: a window. Towards that light
/// it is crossed along side × other.
struct Portal {
    Vec3 corner, side, other;  // the latter two: from that corner to those beside it

    /// Does a ray go out through it?
    bool passes(Vec3 origin, Vec3 direction) const { return density(origin, direction) > 0; }
    /// Of directions (unit) to evenly distributed points of it, sr⁻¹; 0 where they don't go out.
    float density(Vec3 origin, Vec3 direction) const {
        const Vec3 out = cross(side, other);
        const float along = dot(direction, out);
        if (!(along > 0)) return 0;
        const float distance = dot(corner - origin, out) / along;
        const Vec3 from_corner = origin + direction * distance - corner;
        const float a = dot(from_corner, side), b = dot(from_corner, other);
        const bool inside = a >= 0 && a <= dot(side, side) && b >= 0 && b <= dot(other, other);
        return distance > 0 && inside ? distance * distance / along : 0;
    }
    Vec3 at(Vec2 u) const { return corner + side * u.x + other * u.y; }
};
void visit_members(Is<Portal> auto& portal, const auto& visit) {
    auto& [corner, side, other] = portal;
    visit(corner, side, other);
}

struct EnvironmentData {
    Rgb radiance{1, 1, 1};
    std::shared_ptr<const Image> image{};
    enum class Layout { latitude_longitude, equal_area } layout = Layout::latitude_longitude;
    Matrix to_world{};  // a rotation. Latitude-longitude: +y is the top row, -z the picture's middle, +x right of it.
                        // Equal area: the octahedral map of Clarberg (2008) as pbrt lays it out: +z is the centre.
    std::optional<Portal> portal{};  // none: it is seen from everywhere
};
void visit_members(Is<EnvironmentData> auto& environment, const auto& visit) {
    auto& [radiance, image, layout, to_world, portal] = environment;
    visit(radiance, image, layout, to_world, portal);
}

/// Lights that stand for no shape. World space.
struct PointLight {
    Vec3 position;
    Rgb intensity;  // W·sr⁻¹
    LampLabel label{};
    std::optional<EnvironmentData> pattern{};  // times this, by the direction into which it shines
    Matrix luminaire{};                        // turns its own axes, whose straight down is -z, as the file has it
};
void visit_members(Is<PointLight> auto& light, const auto& visit) {
    auto& [position, intensity, label, pattern, luminaire] = light;
    visit(position, intensity, pattern);
}

/// A picture that light passes. At distance 1 along z it is 2 half_width wide and 2 half_height high, dark beyond.
struct Slide {
    std::shared_ptr<const Image> image{};
    Matrix to_world{};  // a rotation, perhaps mirrored: x to the picture's right, y down in it, z ahead
    float half_width = 1, half_height = 1;
    bool even_on_planes = false;  // the intensity is divided by cos³, so that white lights planes across z evenly
};
void visit_members(Is<Slide> auto& slide, const auto& visit) {
    auto& [image, to_world, half_width, half_height, even_on_planes] = slide;
    visit(image, to_world, half_width, half_height, even_on_planes);
}

/// Full intensity within `inner` of its axis, none beyond `outer` (radians), between them as `falloff` says.
struct SpotLight {
    Vec3 position, axis{0, 0, 1};  // axis: unit
    Rgb intensity;                 // W·sr⁻¹, on the axis
    float inner = 0, outer = 0;
    enum class Falloff {  // in the cosine but for `linear`, which is in the angle
        smoothstep,
        linear,
        squared_linear,
        fourth_power
    } falloff = Falloff::smoothstep;
    LampLabel label{};
    std::optional<Slide> slide{};  // times this; z is the axis
    Matrix luminaire{};            // as that of a point, which shines straight down along the axis
};
void visit_members(Is<SpotLight> auto& light, const auto& visit) {
    auto& [position, axis, intensity, inner, outer, falloff, label, slide, luminaire] = light;
    visit(position, axis, intensity, inner, outer, falloff, slide);
}

/// From infinity. With an angle it is a disk in the sky, a sun, which rays can meet.
struct DirectionalLight {
    Vec3 direction{0, 0, -1};  // in which its middle shines, unit
    Rgb irradiance;            // W·m⁻², on a plane across it
    LampLabel label{};
    float half_angle = 0;  // radians, from the middle of the disk to its rim, below π/2; 0: one direction only
};
void visit_members(Is<DirectionalLight> auto& light, const auto& visit) {
    auto& [direction, irradiance, label, half_angle] = light;
    visit(direction, irradiance, half_angle);
}

using BareLight = std::variant<PointLight, SpotLight, DirectionalLight>;

/// One of a scene's shapes, instances or lights while the shutter is open: the scene has it as it is when that opens,
/// and `later` at evenly spaced steps, the last when it closes. Between two steps all numbers go evenly.
template <class State>
struct Moved {
    std::uint32_t which = 0;  // index into the scene's list
    std::vector<State> later;
};
template <class State>
void visit_members(const Moved<State>& moved, const auto& visit) {
    visit(moved.which, moved.later);
}
template <class State>
void visit_members(Moved<State>& moved, const auto& visit) {
    visit(moved.which, moved.later);
}

/// What moves, in the order of the scene's lists. A mesh that does has positions and normals alone, as many as at
/// first.
struct SceneMotion {
    std::vector<Moved<ShapeGeometry>> shapes;
    std::vector<Moved<Matrix>> instances;  // Instance::to_world
    std::vector<Moved<BareLight>> lights;

    /// Of one of a list; none: it stands still.
    template <class State>
    static std::span<const State> steps_after(const std::vector<Moved<State>>& all, std::size_t which) {
        const auto found = std::ranges::lower_bound(all, which, {}, &Moved<State>::which);
        if (found == all.end() || found->which != which) return {};
        return found->later;
    }
    template <class State>
    static std::span<State> steps_after(std::vector<Moved<State>>& all, std::size_t which) {
        const auto found = std::ranges::lower_bound(all, which, {}, &Moved<State>::which);
        if (found == all.end() || found->which != which) return {};
        return found->later;
    }
    bool empty() const { return shapes.empty() && instances.empty() && lights.empty(); }
};
void visit_members(Is<SceneMotion> auto& motion, const auto& visit) {
    auto& [shapes, instances, lights] = motion;
    visit(shapes, instances, lights);
}

struct SceneData {
    std::vector<Shape> shapes;  // those that no object names stand in world space
    std::vector<Object> objects;
    std::vector<Instance> instances;
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<EnvironmentData> environments;  // their radiances add up
    std::vector<BareLight> lights;              // that belong to no shape
    std::vector<std::string> groups{};          // of lamps, which their labels name by index; none: all are one
    std::uint32_t environment_group = 0;        // of all environments
    std::vector<Medium> media{};                // fog, smoke, fire
    std::uint16_t around = Query::no_medium;    // the medium where no shape says otherwise
    CameraData camera;
    bool camera_given = false;           // else Scene looks at everything from where all of it is seen
    std::vector<SceneCamera> cameras{};  // all of the file, where it may have several; the first one is `camera`
    FilmData film;
    std::vector<Problem> warnings;             // what was approximated or left out
    Onlooker as_read{};                        // as the file has it, where a graph changes what the scene says
    std::vector<SceneAnimation> animations{};  // that the file holds, whether or not it was read at some time of one
    SceneMotion motion{};                      // while the shutter is open
    std::optional<ShutterSpan> shutter{};      // as the file itself says
    std::vector<SceneVariant> variants{};      // that the file has
    std::optional<Vec3> up{};                  // of the world, where the format says
};
/// Without those who look (camera, film), without how its lamps are sorted, and without what was said or learnt of it.
void visit_members(Is<SceneData> auto& scene, const auto& visit) {
    auto& [shapes, objects, instances, materials, textures, environments, lights, groups, environment_group, media,
           around, camera, camera_given, cameras, film, warnings, as_read, animations, motion, shutter, variants, up] =
        scene;
    visit(shapes, objects, instances, materials, textures, environments, lights, media, around);
    if (!motion.empty()) visit(motion);  // what stands still is what it was before there was any
}

}  // namespace lightnet
