// lightnet render: renders a scene file, by a graph that it makes of it.
#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "core/base/frame_name.hpp"
#include "core/readers/read_scene.hpp"
#include "core/run/assembly/load_scene.hpp"
#include "tools/cli/launcher.hpp"
#include "tools/cli/loading.hpp"
#include "tools/cli/options.hpp"
#include "tools/cli/render.hpp"
#include "tools/cli/request_of.hpp"
#include "tools/cli/sequence_of.hpp"
#include "tools/words/command_line.hpp"

namespace lightnet {
namespace {

struct RenderOptions {
    RenderedScene scene;
    FrameOptions frames;
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
    app.add_option("--shutter", scene.shutter,
                   "motion blur: how long the shutter is open, of the 360 degrees of a frame: 180 is usual")
        ->type_name("DEGREES")
        ->check(CLI::Range(0.0, 360.0));
    add_constants(app, scene.constants,
                  "define a variable of the scene file, or a constant of GRAPH.lua (may be repeated)");
    add_frames(app, options.frames);
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

/// What the file of the scene says of its picture.
struct ScenePicture {
    FilmData film;
    std::shared_ptr<ReadScene> read;  // for the run
};

/// `running` says what the scene's file leaves open.
RunRequest request_of(const RenderedScene& scene, Written written, RunningOptions running, const Launcher& launcher,
                      std::optional<ScenePicture>& known) {
    if (!known) {
        const auto file = with_frame(scene.file, scene.frame.number);
        auto read = std::make_shared<ReadScene>();
        read->scene = read_scene(read->files, file, constants_of(written.graph));
        const auto film = read->scene.film;
        known = ScenePicture{film, std::move(read)};
    }
    auto& picture = running.picture;
    if (!picture.size) picture.size = PictureSize{known->film.width, known->film.height};
    if (!picture.crop) picture.crop = crop_in_pixels(known->film.crop, *picture.size);
    RunRequest request =
        request_of(running, launcher, validate_job(std::move(written), running.picture, launcher.registry));
    request.read = std::exchange(known->read, nullptr);
    return request;
}

int render_still(const RenderedScene& scene, RunningOptions running, const Launcher& launcher) {
    if (running.picture.output.empty()) running.picture.output = picture_of(scene.file);
    std::optional<ScenePicture> picture;
    return launcher.run(request_of(scene, read_files(scene, running.hosts), running, launcher, picture));
}

// All evaluate their Lua before the scene is read, which starts threads.
int render_scene(const RenderOptions& options, const Launcher& launcher) {
    RenderedScene scene = options.scene;
    if (options.frames.numbers.empty()) return render_still(scene, options.running, launcher);
    RunningOptions running = options.running;
    scene.fps = options.frames.fps;
    if (running.picture.output.empty())
        running.picture.output = std::filesystem::path(without_frame_place(scene.file)).stem().string() + ".####.exr";
    std::map<int, Written> written;
    scene.frame = {0, *std::max_element(options.frames.numbers.begin(), options.frames.numbers.end()), true};
    for (const int number : options.frames.numbers) {
        scene.frame.number = number;
        written.emplace(number, read_files(scene, running.hosts));
    }
    std::optional<ScenePicture> picture;
    return run_frames(options.frames, running, launcher, [&](const GraphFrame& frame, const RunningOptions& own) {
        scene.frame = frame;
        return request_of(scene, std::move(written.at(frame.number)), own, launcher, picture);
    });
}

}  // namespace

Verb render_verb() {
    return verb<RenderOptions>("render", "render a scene file as it is", describe_render, render_scene);
}

}  // namespace lightnet
