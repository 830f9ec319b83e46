// Changes that a graph may make to a scene after it has been read.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/math/rgb.hpp"
#include "core/base/math/vec.hpp"
#include "core/readers/files/files.hpp"
#include "core/readers/part_edits.hpp"
#include "core/scene/data/lamp_names.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet {

/// Of the camera; what is absent stays as the scene has it.
struct CameraOverride {
    std::optional<Vec3> from, to, up;  // world space
    std::optional<float> fov;          // degrees, across the shorter side of the picture
    std::optional<float> lens, focus;  // radius, and distance of what is sharp: metres
};

/// A clear sky and its sun, instead of what is around the scene.
struct SkyOverride {
    std::optional<Vec3> towards;  // the sun; world space; else half-way up
    float turbidity = 3, albedo = 0.2f, scale = 1;
    float sun_scale = 1;             // times that of all
    std::optional<float> sun_angle;  // degrees, from rim to rim; else as it is
};

/// Fog all around.
struct FogOverride {
    float density = 0;  // collisions per metre
    Rgb albedo{1, 1, 1};
    float g = 0;  // mean cosine, -1 … 1 without these
};

/// How one of the scene's lamps shines.
struct ProfileOverride {
    std::string lamp;  // its name, * for any part of one
    std::string path;  // of the luminaire's profile
};

struct SceneOverrides {
    std::string seen_by{};  // camera of the file, by its name or number (1, 2, …); "": the first one
    std::optional<CameraOverride> camera;
    std::vector<CameraOverride> camera_later{};   // of one that moves: at evenly spaced steps, until the shutter closes
    std::optional<CameraOverride> next_camera{};  // one frame later; else as `camera`
    std::variant<std::monostate, Rgb, std::string> environment;  // a colour, or the path of a picture: instead of all
    std::optional<SkyOverride> sky{};
    std::optional<FogOverride> fog{};
    float exposure = 0;               // stops: doublings of the picture's brightness
    bool clay = false;                // all surfaces grey and diffuse
    bool two_sided = false;           // none is black from behind
    std::vector<LampGroup> groups{};  // of lamps
    std::vector<ProfileOverride> profiles{};
    PartEdits parts{};
    std::optional<Vec3> profiles_down{};  // straight down of points with profiles, world space; else their own -z
};

/// Who would look at a scene, which was changed by other overrides, by these: they differ in the camera alone. None: it
/// is not known, or more hangs on it. Throws UserError, which names `where`.
std::optional<Onlooker> look_again(const SceneOverrides& overrides, const SceneData& changed, const SourceLine& where);

/// Changes the scene, the same on every host. Opens files only through `files`. Throws UserError, which names `where`.
void apply(const SceneOverrides& overrides, SceneData& scene, Files& files, const SourceLine& where);

}  // namespace lightnet
