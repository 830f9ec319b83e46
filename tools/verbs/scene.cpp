// lightnet scene info: tells what is in a scene file, and what of it is not supported.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <chrono>
#include <map>
#include <ostream>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/joined.hpp"
#include "core/base/own_process.hpp"
#include "core/readers/read_scene.hpp"
#include "core/readers/statistics.hpp"
#include "core/run/assembly/fingerprint.hpp"
#include "core/scene/data/lamp_names.hpp"
#include "core/scene/scene.hpp"
#include "tools/cli/launcher.hpp"
#include "tools/cli/options.hpp"
#include "tools/cli/render.hpp"
#include "tools/support/exit_code.hpp"
#include "tools/support/pace.hpp"
#include "tools/words/command_line.hpp"

namespace lightnet {
namespace {

using Clock = std::chrono::steady_clock;

std::string mebibytes(std::uint64_t bytes) { return fmt::format("{:.1f} MiB", double(bytes) / (1 << 20)); }

std::string counts_text(const std::map<std::string, std::size_t>& counts) {
    std::string text;
    for (const auto& [name, count] : counts) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, name);
    return text.empty() ? "none" : text;
}

std::string point_text(Vec3 p) { return fmt::format("({:.4g}, {:.4g}, {:.4g})", p.x, p.y, p.z); }

std::string camera_text(const SceneData& scene) {
    const CameraData& camera = scene.camera;
    if (!scene.camera_given) return "none in the file: everything is looked at";
    const auto column = [&](int j) {
        return Vec3{float(camera.to_world.m[0][j]), float(camera.to_world.m[1][j]), float(camera.to_world.m[2][j])};
    };
    std::string text = std::visit([](const auto& projection) { return projection.name; }, camera.projection);
    if (std::holds_alternative<Perspective>(camera.projection)) text += fmt::format(", {:.4g} degrees", camera.fov);
    text += fmt::format(", at {}, looks along {}", point_text(column(3)), point_text(column(2)));
    if (camera.lens_radius > 0)
        text += fmt::format(", lens of radius {:.4g}, in focus at {:.4g} (scene units)", camera.lens_radius,
                            camera.focus_distance);
    return text;
}

void line(std::ostream& out, std::string_view what, const std::string& text) {
    out << fmt::format("{:<14} {}\n", what, text);
}

/// What graphs may call things by: cameras, Select's `material` and `object`, the groups of lamps.
void print_names(const SceneData& scene, std::ostream& out) {
    for (std::size_t i = 0; scene.cameras.size() > 1 && i < scene.cameras.size(); ++i)
        line(out, "camera " + std::to_string(i + 1), scene.cameras[i].name);
    for (std::size_t i = 0; i < scene.animations.size(); ++i) {
        const auto& [name, seconds] = scene.animations[i];
        line(out, scene.animations.size() > 1 ? fmt::format("animation {}", i + 1) : "animation",
             fmt::format("{}{}{:.4g} s", name, name.empty() ? "" : ", ", seconds));
    }
    if (const auto& shutter = scene.shutter; shutter && !scene.animations.empty() && shutter->close > shutter->open)
        line(out, "shutter", fmt::format("open from {:.4g} s to {:.4g} s", shutter->open, shutter->close));
    for (const auto& [name, shown] : scene.variants) line(out, "variant", name + (shown ? " (shown)" : ""));
    for (const auto& lamp : lamps_of(scene)) {
        const std::vector<std::string> others(lamp.names.begin() + 1, lamp.names.end());
        line(out, "lamp",
             fmt::format("{} ({}{}{})", lamp.names.front(), lamp.what,
                         lamp.count > 1 ? fmt::format(", {} times", lamp.count) : "",
                         others.empty() ? "" : ", also " + joined(others)));
    }
    std::set<std::string> materials, objects;
    for (const auto& shape : scene.shapes)
        materials.insert(scene.materials[shape.material].name), objects.insert({shape.name, shape.node_name});
    for (const auto& object : scene.objects) objects.insert(object.name);
    for (const auto& instance : scene.instances) objects.insert(instance.node_name);
    for (const auto& [what, names] : {std::pair("material", &materials), std::pair("object", &objects)})
        for (const auto& name : *names)
            if (!name.empty()) line(out, what, name);
}

void print(const SceneData& scene, const SceneStatistics& found, std::ostream& out) {
    std::string meshes, others;  // the latter beside the triangles, which are all in the former
    for (const auto& [names, count] : found.shapes)
        (std::string_view(names) == Mesh::names ? meshes : others) += fmt::format("{} {}, ", count, names);
    line(out, "triangles",
         fmt::format("{} in {}{} with all instances", found.triangles, meshes, found.instanced_triangles));
    line(out, "shapes", fmt::format("{}{} objects, {} instances", others, found.objects, found.instances));
    line(out, "materials", counts_text(found.materials));
    line(out, "lights", counts_text(found.lights));
    print_names(scene, out);
    line(out, "textures", fmt::format("{}, {} images, {}", found.textures, found.images, mebibytes(found.image_bytes)));
    line(out, "bounds", point_text(found.bounds.low) + " to " + point_text(found.bounds.high));
    line(out, "camera", camera_text(scene));
    line(out, "film",
         fmt::format("{} x {}, brightness times {:.4g}", scene.film.width, scene.film.height, scene.film.scale));
}

struct SceneInfoOptions {
    std::string file;
    std::map<std::string, std::string> constants;  // -D
};

void describe_scene(CLI::App& app, SceneInfoOptions& options) {
    app.require_subcommand(1);
    CLI::App& info = *app.add_subcommand("info", "show what is in a scene file, and what of it is not supported");
    info.fallthrough();  // to what all verbs have
    info.add_option("FILE", options.file, "the scene file")->required();
    add_constants(info, options.constants, "define a variable of the scene file (may be repeated)");
    when_taken_apart(info, [&options] { return mistaken_graph(options.file, "to look at it: lightnet check"); });
    for (auto* one : {&app, &info}) add_examples(*one, {"lightnet scene info graphs/cornell_box.pbrt"});
}

int print_scene_info(const SceneInfoOptions& options, const Launcher& launcher) {
    auto& out = launcher.out;
    const auto begin = Clock::now();
    SceneData scene;
    std::uint64_t file_bytes = 0;
    {
        DiskFiles files;
        scene = read_scene(files, options.file, options.constants);
        for (const auto& [path, bytes] : files.seen()) file_bytes += bytes->size();
    }
    const double reading = seconds_since(begin);
    const SceneStatistics found = statistics_of(scene);
    const auto warnings = scene.warnings;
    line(out, "file", fmt::format("{}, {} with all that it names", options.file, mebibytes(file_bytes)));
    print(scene, found, out);
    SceneOptions settings;
    settings.isa = usual_isa();
    const auto middle = Clock::now();
    const Scene built(std::move(scene), settings);
    line(out, "time", fmt::format("{:.3f} s to read, {:.3f} s to build", reading, seconds_since(middle)));
    const std::uint64_t resident = process_figures().resident;
    std::string memory = fmt::format("{} of shapes, {} in all", mebibytes(found.geometry_bytes), mebibytes(resident));
    if (found.triangles)
        memory += fmt::format("; per triangle {:.0f} bytes, {:.0f} in all",
                              double(found.geometry_bytes) / double(found.triangles),
                              double(resident) / double(found.triangles));
    line(out, "memory", memory);
    if (warnings.empty()) line(out, "approximations", "none");
    for (const auto& warning : warnings) line(out, "approximation", to_string(warning));
    return exit_code::done;
}

}  // namespace

Verb scene_verb() { return verb<SceneInfoOptions>("scene", "look at scene files", describe_scene, print_scene_info); }

}  // namespace lightnet
