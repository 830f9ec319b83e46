// lightnet render: renders a scene file, by a graph that it makes of it.
#include <CLI/CLI.hpp>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "core/readers/read_scene.hpp"
#include "core/run/assembly/load_scene.hpp"
#include "tools/cli/launcher.hpp"
#include "tools/cli/loading.hpp"
#include "tools/cli/options.hpp"
#include "tools/cli/render.hpp"
#include "tools/cli/request_of.hpp"
#include "tools/support/command_line.hpp"

namespace lightnet {
namespace {

struct RenderOptions {
    RenderedScene scene;
    RunningOptions running;
};

void describe_render(CLI::App& app, RenderOptions& options) {
    auto& scene = options.scene;
    app.add_option("FILE", scene.file, "the scene file")->required();
    app.add_option("--lighting", scene.lighting,
                   "path: all light paths; direct: direct light only; ao: ambient occlusion; or a graph file, whose "
                   "scene this one replaces")
        ->type_name("path|direct|ao|GRAPH.lua")
        ->capture_default_str();
    app.add_option("--env", scene.environment, "the environment of the scene: a picture, or a colour like 1,0.9,0.8")
        ->type_name("FILE|COLOUR");
    app.add_flag("--two-sided", scene.two_sided,
                 "surfaces reflect on both sides, also where Mitsuba's are black from behind");
    add_constants(app, scene.constants,
                  "define a variable of the scene file, or a constant of GRAPH.lua (may be repeated)");
    add_running(app, options.running);
    add_output(app, options.running.picture.output, "file of the picture, instead of the scene's name with .exr, here");
    when_taken_apart(app, [&options] {
        const auto mistake = mistaken_graph(options.scene.file, "to render it: lightnet run");
        return mistake ? mistake : settle(options.running);
    });
    add_examples(app, {"lightnet render graphs/cornell_box.pbrt --size 256x256 --samples 16"});
}

/// Of the file that is rendered: those of the graph's scene, as whoever reads it elsewhere takes them.
std::map<std::string, std::string> constants_of(const Graph& graph) {
    for (const Node& node : graph.nodes)
        if (node.kind == "Scene") return scene_constants(node);
    return {};
}

int render_scene(const RenderOptions& options, const Launcher& launcher) {
    const auto& scene = options.scene;
    RunningOptions running = options.running;
    Written written = read_files(scene, running.hosts);
    auto read = std::make_shared<ReadScene>();
    read->scene = read_scene(read->files, scene.file, constants_of(written.graph));
    auto& picture = running.picture;
    const auto& film = read->scene.film;
    if (!picture.size) picture.size = PictureSize{film.width, film.height};
    if (!picture.crop) picture.crop = crop_in_pixels(film.crop, *picture.size);
    if (picture.output.empty()) picture.output = picture_of(scene.file);
    RunRequest request =
        request_of(running, launcher, validate_job(std::move(written), running.picture, launcher.registry));
    request.read = std::move(read);
    return launcher.run(request);
}

}  // namespace

Verb render_verb() {
    return verb<RenderOptions>("render", "render a scene file as it is", describe_render, render_scene);
}

}  // namespace lightnet
