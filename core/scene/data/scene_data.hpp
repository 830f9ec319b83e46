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
#include "core/scene/bare_lights/bare_light.hpp"
#include "core/scene/bare_lights/environment_data.hpp"
#include "core/scene/bsdf/material.hpp"
#include "core/scene/camera/camera_data.hpp"
#include "core/scene/media/medium.hpp"
#include "core/scene/shapes/shape.hpp"
#include "core/scene/textures/texture.hpp"

namespace lightnet {

/// Emission of a shape: radiance in W·sr⁻¹·m⁻² on the side of its normal, or on both.
struct AreaEmission {
    Rgb radiance;
    bool two_sided = false;
    std::optional<TextureId> texture{};  // times this
    LampLabel label{};
    bool unseen = false;  // it shines, and is not there; its material must let all rays through (opacity 0)
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

/// A scene one frame later.
struct NextFrame {
    SceneMotion motion{};                // to where all stands then: one step each; lights are left out
    Onlooker seen_by{};                  // as its file has it
    std::vector<SceneCamera> cameras{};  // as those of the scene
};

/// What a graph may change again and again about a scene, as it was before.
struct UneditedParts {
    std::vector<Material> materials;
    std::size_t textures = 0;             // how many there were
    std::vector<AreaEmission> emissions;  // of the shapes that have one, in their order
    std::vector<BareLight> lights;
    std::vector<Rgb> around;            // radiances of the environments
    std::vector<std::size_t> vertices;  // of each shape that is a mesh: trees put one more behind them
};

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
    std::optional<NextFrame> next{};           // where somebody asks how far things move
    std::optional<UneditedParts> unedited{};   // see edit_parts()
};
/// Without those who look (camera, film), without how its lamps are sorted, and without what was said or learnt of it.
void visit_members(Is<SceneData> auto& scene, const auto& visit) {
    auto& [shapes, objects, instances, materials, textures, environments, lights, groups, environment_group, media,
           around, camera, camera_given, cameras, film, warnings, as_read, animations, motion, shutter, variants, up,
           next, unedited] = scene;
    visit(shapes, objects, instances, materials, textures, environments, lights, media, around);
    if (!motion.empty()) visit(motion);  // what stands still is what it was before there was any
    if (next) visit(next->motion);
}

}  // namespace lightnet
