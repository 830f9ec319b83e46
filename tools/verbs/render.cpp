// lightnet render: renders a scene file, by a graph that it makes of it.
#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "core/base/frame_name.hpp"
#include "core/readers/read_scene.hpp"
#include "core/run/assembly/load_scene.hpp"
#include "tools/cli/auto_lighting.hpp"
#include "tools/cli/launcher.hpp"
#include "tools/cli/lightings.hpp"
#include "tools/cli/loading.hpp"
#include "tools/cli/options.hpp"
#include "tools/cli/render.hpp"
#include "tools/cli/request_of.hpp"
#include "tools/cli/sequence_of.hpp"
#include "tools/support/exit_code.hpp"
#include "tools/trials/trial_laps.hpp"
#include "tools/words/command_line.hpp"

namespace lightnet {
namespace {

struct RenderOptions {
    RenderedScene scene;
    FrameOptions frames;
    RunningOptions running;
};

std::string help_of_lighting() {
    std::string help;
    for (const auto& lighting : lightings()) help += lighting.name + ": " + lighting.shows + "; ";
    return help + std::string(lighting_by_trials) +
           ": whichever short trials find best; or a graph file, whose scene this one replaces";
}

void describe_render(CLI::App& app, RenderOptions& options) {
    auto& scene = options.scene;
    app.add_option("FILE", scene.file, "the scene file")->required();
    app.add_option("--lighting", scene.lighting, help_of_lighting())
        ->type_name("NAME|auto|GRAPH.lua")
        ->capture_default_str();
    app.add_option("--env", scene.environment, "the environment of the scene: a picture, or a colour like 1,0.9,0.8")
        ->type_name("FILE|COLOUR");
    app.add_flag("--two-sided", scene.two_sided,
                 "surfaces reflect on both sides, also where Mitsuba's are black from behind");
    app.add_option("--shutter", scene.shutter,
                   "motion blur: how long the shutter is open, of the 360 degrees of a frame: 180 is usual")
        ->type_name("DEGREES")
        ->check(CLI::Range(0.0, 360.0));
    app.add_option("--animation", scene.animation,
                   "one of several animations of the scene's file (glTF), which scene info lists; *: all at once")
        ->type_name("NAME|N|*");
    add_constants(app, scene.constants,
                  "define a variable of the scene file, or a constant of GRAPH.lua (may be repeated)");
    add_frames(app, options.frames);
    add_running(app, options.running);
    add_output(app, options.running.picture.output, "file of the picture, instead of the scene's name with .exr, here");
    when_taken_apart(app, [&options] {
        const auto mistake = mistaken_graph(options.scene.file, "to render it: lightnet run");
        return mistake ? mistake : settle(options.running);
    });
    add_examples(app, {"lightnet render graphs/cornell_box.pbrt --size 256x256 --samples 16",
                       "lightnet render graphs/glass_ball.pbrt --lighting auto"});
}

/// Of the file that is rendered: those of the graph's scene, as whoever reads it elsewhere takes them.
std::map<std::string, std::string> constants_of(const Graph& graph) {
    for (const Node& node : graph.nodes)
        if (node.kind == "Scene") return scene_constants(graph, node);
    return {};
}

/// What the file of the scene says of its picture.
struct ScenePicture {
    FilmData film;
    std::shared_ptr<ReadScene> read;  // for the run
};

/// Size and crop, where the command line leaves them open.
void settle_picture(PictureOptions& picture, const FilmData& film) {
    if (!picture.size) picture.size = PictureSize{film.width, film.height};
    if (!picture.crop) picture.crop = crop_in_pixels(film.crop, *picture.size);
}

ScenePicture read_picture(const RenderedScene& scene, const Graph& graph) {
    auto read = std::make_shared<ReadScene>();
    read->scene = read_scene(read->files, with_frame(scene.file, scene.frame.number), constants_of(graph));
    const auto film = read->scene.film;
    return {film, std::move(read)};
}

/// `running` says what the scene's file leaves open.
RunRequest request_of(const RenderedScene& scene, Written written, RunningOptions running, const Launcher& launcher,
                      std::optional<ScenePicture>& known) {
    if (!known) known = read_picture(scene, written.graph);
    auto& picture = running.picture;
    settle_picture(picture, known->film);
    const bool named = find_lighting(scene.lighting);
    if (named)
        settle_lighting(written.graph, std::uint64_t{picture.size->width} * picture.size->height,
                        picture.samples.value_or(usual_samples));
    RunRequest request =
        request_of(running, launcher, validate_job(std::move(written), running.picture, launcher.registry));
    if (named) request.lighting.name = scene.lighting;
    request.read = std::exchange(known->read, nullptr);
    return request;
}

/// Makes graphs of scenes, for which Lua is evaluated at once, before the scene is read, which starts threads.
class WrittenRun {
public:
    WrittenRun(RenderedScene scene, const std::string& hosts) : by_trials_(scene.lighting == lighting_by_trials) {
        if (by_trials_) scene.lighting = lightings().front().name;  // until it is known
        written_ = read_files(scene, hosts);
    }
    const Graph& graph() const { return written_.graph; }
    const Hosts& hosts() const { return written_.hosts; }
    bool by_trials() const { return by_trials_; }
    /// Lit in the way that was chosen, if any.
    Written take(const RenderedScene& scene) {
        if (by_trials_) written_.graph = render_graph(scene).graph;
        return std::move(written_);
    }

private:
    bool by_trials_;
    Written written_;
};

/// Of a picture that is gone on with, what it was begun with; else what trials find.
LightingOfRun choose_lighting(const RenderedScene& scene, const WrittenRun& written, RunningOptions running,
                              const Launcher& launcher, std::optional<ScenePicture>& known,
                              const std::vector<std::string>& pictures) {
    if (running.resume)
        if (auto earlier = lighting_of_earlier(pictures); !earlier.name.empty()) return earlier;
    known = read_picture(scene, written.graph());
    settle_picture(running.picture, known->film);
    return lighting_by_trials_of({scene, std::move(running), written.hosts(), std::exchange(known->read, nullptr)},
                                 launcher);
}

int render_still(RenderedScene scene, RunningOptions running, const Launcher& launcher) {
    if (running.picture.output.empty()) running.picture.output = picture_of(scene.file);
    std::optional<ScenePicture> picture;
    WrittenRun written(scene, running.hosts);
    LightingOfRun chosen;
    if (written.by_trials()) {
        chosen = choose_lighting(scene, written, running, launcher, picture, {running.picture.output});
        scene.lighting = chosen.name;
    }
    RunRequest request = request_of(scene, written.take(scene), running, launcher, picture);
    request.lighting.trials = chosen.trials;
    return written.by_trials() && launcher.run_tried ? launcher.run_tried(request) : launcher.run(request);
}

// All evaluate their Lua before the scene is read, which starts threads.
int render_all(const RenderOptions& options, const Launcher& launcher) {
    RenderedScene scene = options.scene;
    const auto& numbers = options.frames.numbers;
    if (numbers.empty()) return render_still(scene, options.running, launcher);
    RunningOptions running = options.running;
    scene.fps = options.frames.fps;
    if (running.picture.output.empty())
        running.picture.output = std::filesystem::path(without_frame_place(scene.file)).stem().string() + ".####.exr";
    std::map<int, WrittenRun> written;
    std::vector<std::string> pictures;
    scene.frame = {0, *std::max_element(numbers.begin(), numbers.end()), true};
    for (const int number : numbers) {
        scene.frame.number = number;
        written.emplace(number, WrittenRun(scene, running.hosts));
        pictures.push_back(with_frame(running.picture.output, number));
    }
    std::optional<ScenePicture> picture;
    LightingOfRun chosen;
    scene.frame.number = numbers.front();
    if (const auto& first = written.at(numbers.front()); first.by_trials()) {
        chosen = choose_lighting(scene, first, running, launcher, picture, pictures);
        scene.lighting = chosen.name;
    }
    return run_frames(options.frames, running, launcher, [&](const GraphFrame& frame, const RunningOptions& own) {
        scene.frame = frame;
        RunRequest request = request_of(scene, written.at(frame.number).take(scene), own, launcher, picture);
        request.lighting.trials = chosen.trials;
        return request;
    });
}

int render_scene(const RenderOptions& options, const Launcher& launcher) try {
    return render_all(options, launcher);
} catch (const TrialInterrupted&) {
    launcher.err << "cancelled: nothing was rendered but trials of lightings\n";
    return exit_code::interrupted;
}

}  // namespace

Verb render_verb() {
    return verb<RenderOptions>("render", "render a scene file as it is", describe_render, render_scene);
}

}  // namespace lightnet
