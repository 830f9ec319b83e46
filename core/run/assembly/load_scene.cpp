#include "core/run/assembly/load_scene.hpp"

#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "core/network/graph/graph_film.hpp"
#include "core/network/graph/lamp_groups.hpp"
#include "core/readers/read_scene.hpp"

namespace lightnet {
namespace {

using Values = std::map<std::string, Value>;

std::optional<float> number(const Values& values, const std::string& name) {
    const auto found = values.find(name);
    return found == values.end() ? std::nullopt : std::optional(float(std::get<double>(found->second.data)));
}

Vec3 triple(const Value& value) {
    const auto& list = std::get<Table>(value.data).list;
    const auto at = [&](std::size_t i) { return float(std::get<double>(list.at(i).data)); };
    return {at(0), at(1), at(2)};
}

std::optional<Vec3> point(const Values& values, const std::string& name) {
    const auto found = values.find(name);
    return found == values.end() ? std::nullopt : std::optional(triple(found->second));
}

CameraOverride camera_of(const Values& camera) {
    return {point(camera, "from"), point(camera, "to"),    point(camera, "up"),
            number(camera, "fov"), number(camera, "lens"), number(camera, "focus")};
}

SkyOverride sky_override(const Values& sky) {
    SkyOverride wanted;
    wanted.towards = point(sky, "towards");
    wanted.turbidity = number(sky, "turbidity").value_or(wanted.turbidity);
    wanted.albedo = number(sky, "albedo").value_or(wanted.albedo);
    wanted.scale = number(sky, "scale").value_or(wanted.scale);
    wanted.sun_scale = number(sky, "sun_scale").value_or(wanted.sun_scale);
    wanted.sun_angle = number(sky, "sun_angle");
    return wanted;
}

FogOverride fog_override(const Values& fog) {
    FogOverride wanted;
    wanted.density = number(fog, "density").value_or(0);
    if (const auto albedo = point(fog, "albedo")) wanted.albedo = {albedo->x, albedo->y, albedo->z};
    wanted.g = number(fog, "g").value_or(0);
    return wanted;
}

// Frames per second, where nobody says otherwise.
constexpr float usual_fps = 24;
// Steps of a camera that the graph moves: it may turn.
constexpr int steps_of_camera = 8;

template <class T>
const T* param_as(const Values& values, const std::string& name) {
    const auto found = values.find(name);
    return found == values.end() ? nullptr : std::get_if<T>(&found->second.data);
}

std::optional<CameraOverride> camera_called(const Values& params, const std::string& name) {
    const auto* camera = param_as<Table>(params, name);
    return camera ? std::optional(camera_of(camera->named)) : std::nullopt;
}

template <class T>
std::optional<T> between(const std::optional<T>& now, const std::optional<T>& then, float part) {
    return now && then ? std::optional<T>(*now + (*then - *now) * part) : now;
}
CameraOverride between(const CameraOverride& now, const CameraOverride& then, float part) {
    return {between(now.from, then.from, part), between(now.to, then.to, part),
            between(now.up, then.up, part),     between(now.fov, then.fov, part),
            between(now.lens, then.lens, part), between(now.focus, then.focus, part)};
}

/// The graph's camera as the shutter opens, at later steps, and as the next frame's shutter opens, on straight ways
/// between the frames.
void move_camera(const Values& params, SceneOverrides& overrides) {
    const auto now = overrides.camera, next = camera_called(params, "next_camera"),
               previous = camera_called(params, "previous_camera");
    const auto* span = param_as<Table>(params, "shutter");
    if (!now || !span || (!next && !previous)) return;
    const auto frames = [&](std::size_t end) { return float(std::get<double>(span->list.at(end).data)); };
    const auto at = [&](float frame) {
        const auto& there = frame < 0 ? previous : next;
        return there ? between(*now, *there, std::fabs(frame)) : *now;
    };
    overrides.camera = at(frames(0));
    overrides.next_camera = between(*now, next ? *next : *now, 1 + frames(0));
    for (int step = 1; step <= steps_of_camera && frames(1) > frames(0); ++step)
        overrides.camera_later.push_back(at(frames(0) + (frames(1) - frames(0)) * float(step) / steps_of_camera));
}

std::map<std::string, Rgb> colours_by_name(const Values& params, const std::string& name) {
    std::map<std::string, Rgb> colours;
    const auto* given = param_as<Table>(params, name);
    if (!given) return colours;
    for (const auto& [part, value] : given->named) {
        const auto* grey = std::get_if<double>(&value.data);
        const Vec3 colour = grey ? Vec3{float(*grey), float(*grey), float(*grey)} : triple(value);
        colours[part] = {colour.x, colour.y, colour.z};
    }
    return colours;
}

PartEdits part_edits(const Values& params) {
    return {colours_by_name(params, "lamps"), colours_by_name(params, "colours"), colours_by_name(params, "roughness"),
            number(params, "environment_scale").value_or(1)};
}

std::string frame_beside(const Graph& graph, const Table& frame, double fps) {
    FrameBeside beside{1 / fps};
    if (const auto* time = param_as<double>(frame.named, "time")) beside.time = *time;
    if (const auto* file = param_as<std::string>(frame.named, "file")) beside.file = beside_graph(graph, *file);
    return to_constant(beside);
}

}  // namespace

SceneOverrides scene_overrides(const Graph& graph, const Registry& registry) {
    const Values& params = scene_of(graph, registry).params;
    SceneOverrides overrides;
    if (const auto chosen = params.find("seen_by"); chosen != params.end())
        overrides.seen_by = std::get<std::string>(chosen->second.data);
    overrides.camera = camera_called(params, "camera");
    overrides.next_camera = camera_called(params, "next_camera");
    move_camera(params, overrides);
    if (const auto around = params.find("environment"); around != params.end()) {
        if (const auto* file = std::get_if<std::string>(&around->second.data)) {
            overrides.environment = beside_graph(graph, *file);
        } else {
            const Vec3 colour = triple(around->second);
            overrides.environment = Rgb{colour.x, colour.y, colour.z};
        }
    }
    if (const auto sky = params.find("sky"); sky != params.end())
        overrides.sky = sky_override(std::get<Table>(sky->second.data).named);
    if (const auto fog = params.find("fog"); fog != params.end())
        overrides.fog = fog_override(std::get<Table>(fog->second.data).named);
    overrides.parts = part_edits(params);
    overrides.exposure = number(params, "exposure").value_or(0);
    overrides.clay = params.contains("material");
    const auto two_sided = params.find("two_sided");
    overrides.two_sided = two_sided != params.end() && std::get<bool>(two_sided->second.data);
    if (const auto groups = params.find("groups"); groups != params.end())
        for (const auto& [name, lamps] : std::get<Table>(groups->second.data).named)
            overrides.groups.push_back({name, names_in(lamps)});
    if (const auto profiles = params.find("ies"); profiles != params.end())
        for (const auto& [lamp, files] : std::get<Table>(profiles->second.data).named)
            for (const std::string& file : names_in(files))
                overrides.profiles.push_back({lamp, beside_graph(graph, file)});
    overrides.profiles_down = point(params, "ies_down");
    return overrides;
}

std::map<std::string, std::string> scene_constants(const Graph& graph, const Node& scene) {
    std::map<std::string, std::string> constants;
    const auto given = scene.params.find("constants"), variant = scene.params.find("variant");
    if (given != scene.params.end())
        if (const auto* table = std::get_if<Table>(&given->second.data))
            for (const auto& [name, value] : table->named) {
                const auto* text = std::get_if<std::string>(&value.data);
                constants[name] = text ? *text : to_string(value);
            }
    // to the reader they are two more variables of the file
    if (variant != scene.params.end())
        if (const auto* name = std::get_if<std::string>(&variant->second.data)) constants["variant"] = *name;
    if (const auto version = scene.params.find("pbrt"); version != scene.params.end())
        if (const auto* number = std::get_if<double>(&version->second.data))
            constants["pbrt"] = to_string(Value{*number});
    if (const auto animation = scene.params.find("animation"); animation != scene.params.end())
        if (const auto* name = std::get_if<std::string>(&animation->second.data))
            constants[std::string(animation_constant)] = *name;
    if (const auto time = scene.params.find("time"); time != scene.params.end())
        if (std::holds_alternative<double>(time->second.data))
            constants[std::string(time_constant)] = to_string(time->second);
    if (const auto* objects = param_as<Table>(scene.params, "subdivision"))
        for (const auto& [object, times] : objects->named)
            constants[std::string(subdivision_constant) + object] = to_string(times);
    const auto* rate = param_as<double>(scene.params, "fps");
    const double fps = rate ? *rate : usual_fps;
    if (const auto* span = param_as<Table>(scene.params, "shutter"); span && span->list.size() == 2) {
        const auto seconds = [&](std::size_t i) {
            const auto* frames = std::get_if<double>(&span->list[i].data);
            return to_string(Value{frames ? *frames / fps : 0});
        };
        constants[std::string(shutter_constant)] = seconds(0) + " " + seconds(1);
    }
    if (const auto* frame = param_as<Table>(scene.params, "previous"))
        constants[std::string(previous_constant)] = frame_beside(graph, *frame, fps);
    if (const auto* frame = param_as<Table>(scene.params, "next"))
        constants[std::string(next_constant)] = frame_beside(graph, *frame, fps);
    return constants;
}

std::map<std::string, std::string> scene_constants(const Graph& graph, const Registry& registry) {
    return scene_constants(graph, scene_of(graph, registry));
}

std::optional<Onlooker> another_look(const Graph& graph, const Registry& registry, const SceneData& changed) {
    return look_again(scene_overrides(graph, registry), changed, scene_of(graph, registry).where);
}

void edit_again(const Graph& graph, const Registry& registry, SceneData& changed) {
    edit_parts(part_edits(scene_of(graph, registry).params), changed, scene_of(graph, registry).where);
}

void find_mistakes(const Graph& graph, const Registry& registry, const SceneData& scene,
                   std::vector<Problem>& problems) {
    for (const auto& node : graph.nodes)
        if (const Kind* kind = registry.find(node.kind); kind && kind->mistakes)
            for (const auto& what : kind->mistakes(node, &scene))
                problems.push_back({node.where, node.kind + " '" + node.name + "': " + what});
}

LoadedScene override_scene(const Graph& graph, const Registry& registry, Files& files, SceneData scene) {
    apply(scene_overrides(graph, registry), scene, files, scene_of(graph, registry).where);
    std::vector<Problem> problems;
    auto kept = read_kept(graph, registry, files, scene, problems);
    find_mistakes(graph, registry, scene, problems);
    if (!problems.empty()) throw UserError(std::move(problems));
    return {std::move(scene), std::move(kept)};
}

LoadedScene load_scene(const Graph& graph, const Registry& registry, Files& files, const std::string& path) {
    return override_scene(graph, registry, files, read_scene(files, path, scene_constants(graph, registry)));
}

}  // namespace lightnet
