#include "core/network/graph/kind.hpp"

#include <algorithm>
#include <cassert>

#include "core/network/graph/graph.hpp"

namespace lightnet {
namespace {

bool by_name(const Kind& a, const Kind& b) { return a.name < b.name; }

std::vector<Param> camera_fields() {
    const auto point = [](const char* name, const char* help) {
        return Param{.name = name, .type = ParamType::numbers, .help = help, .optional = true, .count = 3};
    };
    return {point("from", "where it stands"),
            point("to", "what is in the middle of the image"),
            point("up", "what is up in the image"),
            {.name = "fov",
             .help = "field of view: angle across the shorter side of the image",
             .unit = "degrees",
             .least = 0.001,
             .most = 179,
             .optional = true},
            {.name = "lens", .help = "radius of the lens", .unit = "scene units", .least = 0, .optional = true},
            {.name = "focus", .help = "distance in focus", .unit = "scene units", .least = 1e-6, .optional = true}};
}

std::vector<Param> sky_fields() {
    return {
        {.name = "towards",
         .type = ParamType::numbers,
         .help = "where the sun stands: from the scene towards it; by default half-way up",
         .optional = true,
         .count = 3},
        {.name = "turbidity",
         .help = "haze: 2 is arctic air, 3 (the default) a clear day, 10 a hazy one",
         .least = 1,
         .most = 10,
         .optional = true},
        {.name = "albedo",
         .help = "what the ground sends back to the sky; 0.2 by default",
         .least = 0,
         .most = 1,
         .optional = true},
        {.name = "scale", .help = "times all its light, which else is in W/(m²·sr·nm)", .least = 0, .optional = true},
        {.name = "sun_scale", .help = "times the light of the sun; 0: none", .least = 0, .optional = true},
        {.name = "sun_angle",
         .help = "of the sun from rim to rim, with the same light; 0: shadows without soft edges",
         .unit = "degrees",
         .least = 0,
         .most = 179,
         .optional = true}};
}

std::vector<Param> fog_fields() {
    return {{.name = "density", .help = "collisions of light per scene unit", .unit = "1 / scene unit", .least = 0},
            {.name = "albedo",
             .type = ParamType::numbers,
             .help = "share of them that scatters: red, green, blue; 1 by default",
             .optional = true,
             .count = 3},
            {.name = "g",
             .help = "mean cosine of directions (Henyey and Greenstein): 0 by default, above it light goes on ahead",
             .least = -0.99,
             .most = 0.99,
             .optional = true}};
}

std::vector<Param> frame_beside_fields() {
    return {{.name = "file", .type = ParamType::text, .help = "else the same", .optional = true},
            {.name = "time", .help = "of what moves in it; else the same", .unit = "seconds", .optional = true}};
}

std::vector<std::string> scene_mistakes(const Node& node, const SceneData*) {
    const auto shutter = node.params.find("shutter");
    if (shutter == node.params.end()) return {};
    const auto& span = std::get<Table>(shutter->second.data).list;
    const auto frames = [&](std::size_t i) { return std::get<double>(span.at(i).data); };
    if (frames(1) >= frames(0)) return {};
    return {"'shutter' closes before it opens: { open, close }, in frames, such as { 0, 0.5 }"};
}

Kind scene_kind() {
    Kind kind;
    kind.mistakes = scene_mistakes;
    kind.name = "Scene";
    kind.role = Role::scene;
    kind.help = "what is seen: Scene { \"file.pbrt\" }, the file named from the graph's folder";
    kind.params = {
        {.name = "camera",
         .type = ParamType::table,
         .help = "changes the camera; what is left out stays as the file says",
         .optional = true,
         .fields = camera_fields()},
        {.name = "seen_by",
         .type = ParamType::text,
         .help = "one of several cameras of the file, by its name or number (1, 2, …)",
         .optional = true},
        {.name = "environment",
         .type = ParamType::surrounding,
         .help =
             "instead of what the file has around the scene; images: equal-area where square, else latitude-longitude",
         .optional = true},
        {.name = "sky",
         .type = ParamType::table,
         .help = "a clear sky in daytime and its sun, instead of what the file has around the scene",
         .optional = true,
         .fields = sky_fields()},
        {.name = "fog",
         .type = ParamType::table,
         .help = "fills all space with fog, but for the inside of solid glass and of what the file fills by itself",
         .optional = true,
         .fields = fog_fields()},
        {.name = "environment_scale", .help = "times what is around the scene", .initial = Value{1.0}, .least = 0},
        {.name = "exposure",
         .help = "how many times the image becomes twice as bright",
         .unit = "stops",
         .initial = Value{0.0},
         .least = -64,
         .most = 64},
        {.name = "constants",
         .type = ParamType::table,
         .help = "values for variables of the file (Mitsuba's <default>s), by their names",
         .optional = true},
        {.name = "variant",
         .type = ParamType::text,
         .help = "one of several variants of the file's materials (glTF), by its name",
         .optional = true},
        {.name = "subdivision",
         .type = ParamType::table,
         .help =
             "how often faces of objects of an OBJ file are split, 0 to 8 times, into a smooth surface (Catmull and "
             "Clark's): by the objects' names, * for any part of one; 3 where the file has tags of subdivision",
         .optional = true},
        {.name = "pbrt",
         .type = ParamType::integer,
         .help = "the version of pbrt, 3 or 4, whose meaning a .pbrt file has; else what it says by itself tells",
         .least = 3,
         .most = 4,
         .optional = true},
        {.name = "animation",
         .type = ParamType::text,
         .help = "one of several animations of the file (glTF): its name, its number from 1 on, or * for all at once; "
                 "else the first",
         .optional = true},
        {.name = "time",
         .help = "of what moves in the file; else that of the frame, and in a still all stands as the file has it",
         .unit = "seconds",
         .optional = true},
        {.name = "shutter",
         .type = ParamType::numbers,
         .help =
             "when it opens and closes, after the time: { 0, 0.5 } is half a frame, a shutter of 180 degrees; what "
             "moves in the file meanwhile is blurred; else that of the file's own camera (pbrt, Mitsuba), in a still",
         .unit = "frames",
         .optional = true,
         .count = 2},
        {.name = "fps",
         .help = "frames per second, of which the shutter's are; else those of the graph",
         .least = 1e-6,
         .optional = true},
        {.name = "next",
         .type = ParamType::table,
         .help =
             "the scene one frame later, for a shutter and for who asks for motion; found in the graph's own frames",
         .optional = true,
         .fields = frame_beside_fields()},
        {.name = "next_camera",
         .type = ParamType::table,
         .help = "'camera' one frame later; found in the graph's own frames",
         .optional = true,
         .fields = camera_fields()},
        {.name = "previous",
         .type = ParamType::table,
         .help = "the scene one frame earlier, for a shutter that opens then; found in the graph's own frames",
         .optional = true,
         .fields = frame_beside_fields()},
        {.name = "previous_camera",
         .type = ParamType::table,
         .help = "'camera' one frame earlier; found in the graph's own frames",
         .optional = true,
         .fields = camera_fields()},
        {.name = "material",
         .type = ParamType::text,
         .help = "clay: all surfaces are grey and diffuse; lamps and cut-outs stay",
         .choices = {"clay"},
         .optional = true},
        {.name = "groups",
         .type = ParamType::named_lists,
         .help = "groups of lamps, each the names of its lamps, * for any part of one; what is in none is in 'rest'",
         .optional = true},
        {.name = "ies",
         .type = ParamType::named_lists,
         .help = "profiles of luminaires (.ies) for points and spots, by the lamps' names, * for any part of one",
         .optional = true},
        {.name = "ies_down",
         .type = ParamType::numbers,
         .help = "straight down of points with such profiles, in world space; else -z of their own axes in the file",
         .optional = true,
         .count = 3},
        {.name = "lamps",
         .type = ParamType::named_colours,
         .help = "times which lamps shine as in the file, by their names, * for any part of one, environment: around",
         .least = 0,
         .optional = true},
        {.name = "colours",
         .type = ParamType::named_colours,
         .help = "colours of materials instead of the file's, by their names, * for any part of one",
         .least = 0,
         .most = 1,
         .optional = true},
        {.name = "roughness",
         .type = ParamType::named_colours,
         .help = "roughness of materials instead of the file's, 0: smooth, by their names, * for any part of one",
         .least = 0,
         .most = 1,
         .optional = true},
        {.name = "two_sided",
         .type = ParamType::flag,
         .help =
             "surfaces that the file has black from behind (Mitsuba's, without a twosided) look alike on both sides",
         .optional = true}};
    return kind;
}

// What all kinds that have to do with lamps have.
void add_lamp_params(Kind& kind) {
    if (kind.light.lamps)
        kind.params.push_back({.name = "lamps",
                               .type = ParamType::names,
                               .help = "groups of the scene's lamps that it looks for; none: all lamps",
                               .initial = Value{Table{}}});
    if (kind.light.groups)
        kind.params.push_back({.name = "groups",
                               .type = ParamType::flag,
                               .help = "keeps the scene's groups of lamps apart: a layer for each",
                               .initial = Value{false}});
}

Kind kind_of_left_out() {
    Kind kind;
    kind.name = left_out_kind;
    kind.help = "answers black";
    kind.light.space = kind.light.lamps = kind.light.groups = true;
    kind.light.paths = always({});
    kind.reads = reading(SceneParts());
    add_lamp_params(kind);
    return kind;
}

}  // namespace

std::function<SceneParts(const Node&)> reading(SceneParts parts) {
    return [parts](const Node&) { return parts; };
}

SceneParts reads_of(const Kind& kind, const Node& node) { return kind.reads ? kind.reads(node) : whole_scene; }

std::function<std::vector<std::string>(const Node&)> always(std::vector<std::string> paths) {
    return [paths = std::move(paths)](const Node&) { return paths; };
}

PassedOn passed_on(const Kind& kind, const Node& node) {
    PassedOn passed{{}, kind.light.partial};
    if (kind.light.passed) passed = kind.light.passed(node);
    if (!kind.light.space && passed.ends.empty()) passed.ends = ends_at_surface;
    return passed;
}

Registry::Registry(std::vector<Kind> kinds) {
    kinds.push_back(scene_kind());
    add(std::move(kinds));
}

void Registry::add(std::vector<Kind> kinds) {
    std::ranges::for_each(kinds, add_lamp_params);
    std::ranges::move(kinds, std::back_inserter(kinds_));
    std::sort(kinds_.begin(), kinds_.end(), by_name);
    assert(std::adjacent_find(kinds_.begin(), kinds_.end(),
                              [](const Kind& a, const Kind& b) { return a.name == b.name; }) == kinds_.end() &&
           "each kind has a name of its own");
}

void Registry::add_plugin(const std::string& plugin, std::vector<Kind> kinds) {
    for (auto& kind : kinds) kind.plugin = plugin;
    add(std::move(kinds));
    plugins_.insert(plugin);
}

const Kind* Registry::find(std::string_view name) const {
    static const Kind left_out = kind_of_left_out();
    if (name == left_out_kind) return &left_out;
    const auto at = std::find_if(kinds_.begin(), kinds_.end(), [&](const Kind& kind) { return kind.name == name; });
    return at == kinds_.end() ? nullptr : &*at;
}

std::string_view to_string(Role role) {
    switch (role) {
        case Role::light:
            return "light";
        case Role::image:
            return "image";
        case Role::scene:
            return "scene";
    }
    return "";
}

std::string_view to_string(ParamType type) {
    switch (type) {
        case ParamType::number:
            return "number";
        case ParamType::integer:
            return "integer";
        case ParamType::flag:
            return "flag";
        case ParamType::text:
            return "text";
        case ParamType::numbers:
            return "numbers";
        case ParamType::table:
            return "table";
        case ParamType::surrounding:
            return "file or colour";
        case ParamType::film:
            return "film";
        case ParamType::scene:
            return "scene";
        case ParamType::node:
            return "node";
        case ParamType::nodes:
            return "list of nodes";
        case ParamType::names:
            return "name or list of names";
        case ParamType::named_lists:
            return "table of names";
        case ParamType::named_colours:
            return "table of colours";
    }
    return "";
}

}  // namespace lightnet
