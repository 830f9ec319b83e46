#include "core/readers/overrides.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/base/in_quotes.hpp"
#include "core/base/joined.hpp"
#include "core/base/suggestion.hpp"
#include "core/readers/common/below_black.hpp"
#include "core/readers/common/report.hpp"
#include "core/readers/daylight/daylight.hpp"
#include "core/readers/images/image_facts.hpp"
#include "core/readers/images/image_file.hpp"
#include "core/readers/images/known_images.hpp"
#include "core/readers/lamp_profiles.hpp"
#include "core/scene/reach.hpp"

namespace lightnet {
namespace {

Vec3 column(const Matrix& m, int j) { return {float(m.m[0][j]), float(m.m[1][j]), float(m.m[2][j])}; }

void set_column(Matrix& m, int j, Vec3 v) { m.m[0][j] = v.x, m.m[1][j] = v.y, m.m[2][j] = v.z; }

/// Looks from one point to another. Where x is, in the picture, is a matter of the world's handedness: as it was.
void look(CameraData& camera, const CameraOverride& change, bool given, const SourceLine& where) {
    if (!given && !(change.from && change.to))
        throw UserError(where, "'camera': the scene has none of its own, so both 'from' and 'to' must be given");
    const Matrix old = camera.to_world;
    const Vec3 from = change.from.value_or(column(old, 3)), to = change.to.value_or(from + column(old, 2));
    const Vec3 up = change.up.value_or(given ? column(old, 1) : Vec3{0, 1, 0});
    const Vec3 ahead = to - from;
    const bool mirrored = given ? swaps_handedness(old) : true;
    const Vec3 right = mirrored ? cross(ahead, up) : cross(up, ahead);
    if (!(length(right) > 1e-6f * length(ahead) * length(up)) || !finite(right))
        throw UserError(where, "'camera': 'from', 'to' and 'up' must span a view");
    const Vec3 z = normalize(ahead), x = normalize(right), y = mirrored ? cross(x, z) : cross(z, x);
    set_column(camera.to_world, 0, x);
    set_column(camera.to_world, 1, y);
    set_column(camera.to_world, 2, z);
    set_column(camera.to_world, 3, from);
}

void change_camera(SceneData& scene, const CameraOverride& change, const SourceLine& where) {
    CameraData& camera = scene.camera;
    if (change.from || change.to || change.up) {
        look(camera, change, scene.camera_given, where);
        scene.camera_given = true;
        camera.later.clear();  // it stands where the graph says
    }
    const auto change_step = [&](CameraData& step) {
        if (change.fov) step.fov = *change.fov, step.projection = Perspective{};
        if (change.lens) step.lens_radius = *change.lens;
        if (change.focus) step.focus_distance = *change.focus;
    };
    change_step(camera);
    std::ranges::for_each(camera.later, change_step);
    if (!scene.camera_given) return;
    if (const auto fault = camera_fault(camera, scene.film); !fault.empty())
        throw UserError(where, "'camera': " + fault);
}

void choose_camera(SceneData& scene, const std::string& wanted, const SourceLine& where) {
    const auto& cameras = scene.cameras;
    std::vector<std::string> names;
    for (std::size_t i = 0; i < cameras.size(); ++i)
        names.push_back(cameras[i].name.empty() ? std::to_string(i + 1) : cameras[i].name);
    auto found = std::find(names.begin(), names.end(), wanted);
    std::size_t number = 0;
    const auto [end, wrong] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), number);
    if (found == names.end() && wrong == std::errc() && end == wanted.data() + wanted.size() && number >= 1 &&
        number <= names.size())
        found = names.begin() + std::ptrdiff_t(number - 1);
    if (found == names.end()) {
        const auto guess = did_you_mean(wanted, names);
        throw UserError(where, "there is no camera " + in_quotes(wanted) +
                                   (names.empty()   ? ": the scene's file has none to choose from"
                                    : guess.empty() ? " (there is: " + joined(names) + ")"
                                                    : guess));
    }
    const auto& chosen = cameras[std::size_t(found - names.begin())];
    scene.camera = chosen.camera;
    scene.film = chosen.film;
    scene.camera_given = true;
}

// At one time, who was given before.
void look_at_one_time(const SceneOverrides& overrides, const std::optional<CameraOverride>& change, SceneData& scene,
                      const SourceLine& where) {
    if (!overrides.seen_by.empty()) choose_camera(scene, overrides.seen_by, where);
    if (change) change_camera(scene, *change, where);
}

SceneData onlookers(const Onlooker& first, const std::vector<SceneCamera>& all) {
    SceneData scene;
    scene.camera = first.camera;
    scene.camera_given = first.given;
    scene.film = first.film;
    scene.cameras = all;
    return scene;
}

void look_as_wanted(const SceneOverrides& overrides, SceneData& scene, const SourceLine& where) {
    const SceneData before = onlookers({scene.camera, scene.camera_given, scene.film}, scene.cameras);
    look_at_one_time(overrides, overrides.camera, scene, where);
    if (scene.camera.later.empty())  // else the file's own moves, and the graph says nothing of where it is
        for (const auto& step : overrides.camera_later) {
            SceneData then = before;
            look_at_one_time(overrides, step, then, where);
            scene.camera.later.push_back(then.camera);
        }
    if (!scene.next && !overrides.next_camera) return;
    SceneData then = scene.next ? onlookers(scene.next->seen_by, scene.next->cameras) : before;
    look_at_one_time(overrides, overrides.next_camera ? overrides.next_camera : overrides.camera, then, where);
    if (then.camera_given) scene.camera.next = {then.camera};
}

/// Up as the format has it; else the axis of the world that is up for the camera: scenes stand on z or on y.
Vec3 upwards(const SceneData& scene) {
    if (scene.up) return *scene.up;
    const Vec3 up = scene.camera_given ? column(scene.camera.to_world, 1) : Vec3{0, 1, 0};
    const Vec3 size{std::fabs(up.x), std::fabs(up.y), std::fabs(up.z)};
    if (size.y >= size.x && size.y >= size.z) return {0, up.y < 0 ? -1.0f : 1.0f, 0};
    if (size.z >= size.x) return {0, 0, up.z < 0 ? -1.0f : 1.0f};
    return {up.x < 0 ? -1.0f : 1.0f, 0, 0};
}

/// Turns axis `pole` of a picture's own space to `up`; the other two follow in order.
Matrix stand_up(int pole, Vec3 up) {
    // one of the others stays where it is; only where `up` lies along it, the pole goes there
    const auto unit = [](int axis) { return Vec3{float(axis == 0), float(axis == 1), float(axis == 2)}; };
    Vec3 next = unit((pole + 2) % 3);
    if (dot(next, up) != 0) next = unit(pole);
    Matrix turn;
    set_column(turn, pole, up);
    set_column(turn, (pole + 2) % 3, next);
    set_column(turn, (pole + 1) % 3, cross(next, up));
    return turn;
}

EnvironmentData picture_around(const std::string& path, SceneData& scene, Files& files, const SourceLine& where) {
    EnvironmentData environment;
    try {
        expect_image(files.beginning(path, image_beginning));
        const Bytes file = files.read(path);
        auto known = known_image(file, {});
        if (!known) {
            auto [image, strange] = sound(read_image(*file));
            known = {std::make_shared<const Image>(std::move(image)), std::move(strange)};
            remember_image(file, {}, *known);
        }
        const auto& remark = known->remark;
        environment.image = known->image;
        for (const std::string& said : {remark, below_black(*environment.image)})
            if (!said.empty()) scene.warnings.push_back({where, "'environment': '" + path + "': " + said});
    } catch (const Error& problem) {
        throw UserError(where, "'environment': can't read '" + path + "': " + problem.what());
    }
    const bool square = environment.image->width == environment.image->height;
    environment.layout = square ? EnvironmentData::Layout::equal_area : EnvironmentData::Layout::latitude_longitude;
    environment.to_world = stand_up(square ? 2 : 1, upwards(scene));
    return environment;
}

void put_sky(const SkyOverride& wanted, SceneData& scene, const SourceLine& where) {
    Daylight day;
    day.up = upwards(scene);
    const Matrix turn = stand_up(1, day.up);
    const Vec3 towards = wanted.towards.value_or(transform_direction(turn, {0, 1, 1}));
    const float size = length(towards);
    if (!(size > 0)) throw UserError(where, "'sky': 'towards' must be a direction, not { 0, 0, 0 }");
    day.to_sun = towards / size;
    const float height = dot(day.up, day.to_sun);
    if (height < 0)
        throw UserError(where, fmt::format("'sky': the sun is {:.1f}° below the horizon (up is {{ {}, {}, {} }}), and "
                                           "the sky is known by day only",
                                           std::asin(std::min(1.0f, -height)) * 180 / std::numbers::pi_v<float>,
                                           day.up.x, day.up.y, day.up.z));
    day.turbidity = wanted.turbidity;
    day.albedo = Rgb{1, 1, 1} * wanted.albedo;
    day.scale = wanted.scale;
    scene.environments = {sky_of(day)};
    day.scale *= wanted.sun_scale;
    const float angle = wanted.sun_angle ? *wanted.sun_angle / 2 * std::numbers::pi_v<float> / 180 : angle_of_sun;
    if (day.scale > 0) scene.lights.push_back(sun_of(day, angle));
}

/// What is cut out stays cut out, and what isn't there stays away.
void make_clay(SceneData& scene) {
    scene.textures.push_back({{0.5f, 0.5f, 0.5f}, {}, false});
    const auto grey = static_cast<TextureId>(scene.textures.size() - 1);
    for (auto& material : scene.materials) {
        if (std::holds_alternative<NoMaterial>(material.model)) continue;
        Material clay;
        clay.name = std::move(material.name);
        clay.model = DiffuseMaterial{grey, 0, std::nullopt};
        clay.opacity = material.opacity;
        clay.opacity_cutoff = material.opacity_cutoff;
        material = std::move(clay);
    }
}

/// Solid glass stays empty, and what the file fills stays as it is.
void put_fog(const FogOverride& wanted, SceneData& scene, const SourceLine& where) {
    Medium fog;
    fog.name = "fog";
    fog.where = where;
    fog.extinction.value = Rgb{1, 1, 1} * wanted.density;
    fog.albedo.value = wanted.albedo;
    if (wanted.g != 0) fog.phase = {PhaseFunction::Law::henyey_greenstein, wanted.g};
    if (const auto fault = fog.fault(); !fault.empty() || max_component(wanted.albedo) > 1)
        throw UserError(where, "'fog': " + (fault.empty() ? "an 'albedo' can't be above 1" : fault));
    const auto index = static_cast<std::uint16_t>(scene.media.size());
    for (Shape& shape : scene.shapes) {
        const bool solid = shape.material < scene.materials.size() &&
                           transparency_of(scene.materials[shape.material]) == Transparency::solid;
        if (!shape.media && solid) shape.media = MediumSides{};
        if (shape.media && shape.media->outside == scene.around) shape.media->outside = index;
    }
    scene.media.push_back(std::move(fog));
    scene.around = index;
}

std::optional<Vec3> direction_down(const SceneOverrides& overrides, const SourceLine& where) {
    if (!overrides.profiles_down) return std::nullopt;
    const float size = length(*overrides.profiles_down);
    if (!(size > 0)) throw UserError(where, "'ies_down' must be a direction, not { 0, 0, 0 }");
    return *overrides.profiles_down / size;
}

}  // namespace

std::optional<Onlooker> look_again(const SceneOverrides& overrides, const SceneData& changed, const SourceLine& where) {
    SceneData scene = onlookers(changed.as_read, changed.cameras);
    scene.up = changed.up;
    if (changed.next) scene.next = {{}, changed.next->seen_by, changed.next->cameras};
    look_as_wanted(overrides, scene, where);
    const bool stands_by_camera = overrides.sky || std::holds_alternative<std::string>(overrides.environment);
    if (!scene.camera_given || (stands_by_camera && !(upwards(scene) == upwards(changed)))) return std::nullopt;
    scene.film.scale *= std::exp2(overrides.exposure);
    return Onlooker{scene.camera, true, scene.film};
}

void apply(const SceneOverrides& overrides, SceneData& scene, Files& files, const SourceLine& where) {
    scene.as_read = {scene.camera, scene.camera_given, scene.film};
    look_as_wanted(overrides, scene, where);
    if (const auto* colour = std::get_if<Rgb>(&overrides.environment)) {
        scene.environments.clear();
        if (!is_black(*colour)) scene.environments.emplace_back().radiance = *colour;
    } else if (const auto* path = std::get_if<std::string>(&overrides.environment)) {
        scene.environments = {picture_around(*path, scene, files, where)};
    }
    if (overrides.sky) {
        if (!std::holds_alternative<std::monostate>(overrides.environment))
            throw UserError(where, "'sky' and 'environment': only one of them can be around the scene");
        put_sky(*overrides.sky, scene, where);
    }
    if (overrides.sky || !std::holds_alternative<std::monostate>(overrides.environment))
        std::erase_if(scene.warnings, [](const Problem& said) { return said.what.ends_with(choose_around); });
    if (overrides.fog) put_fog(*overrides.fog, scene, where);
    scene.film.scale *= std::exp2(overrides.exposure);
    if (overrides.clay) make_clay(scene);
    if (overrides.two_sided)
        for (auto& material : scene.materials) material.one_sided = false;
    if (!overrides.profiles.empty())
        put_profiles(overrides.profiles, direction_down(overrides, where), scene, files, where);
    std::vector<Problem> problems;
    if (!overrides.groups.empty())
        for (auto& mistake : sort_lamps(scene, overrides.groups)) problems.push_back({where, "'groups': " + mistake});
    if (!problems.empty()) throw UserError(std::move(problems));
    edit_parts(overrides.parts, scene, where);
}

}  // namespace lightnet
