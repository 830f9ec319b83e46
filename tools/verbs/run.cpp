// lightnet run: renders a graph.
#include <optional>
#include <string>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/frame_name.hpp"
#include "core/network/graph/graph_film.hpp"
#include "core/network/graph/value.hpp"
#include "tools/cli/frames.hpp"
#include "tools/cli/launcher.hpp"
#include "tools/cli/lay_out.hpp"
#include "tools/cli/loading.hpp"
#include "tools/cli/options.hpp"
#include "tools/cli/overrides.hpp"
#include "tools/cli/request_of.hpp"
#include "tools/cli/sequence_of.hpp"
#include "tools/words/command_line.hpp"

namespace lightnet {
namespace {

struct RunOptions {
    GraphOptions graph;
    FrameOptions frames;
    RunningOptions running;
};

void describe_run(CLI::App& app, RunOptions& options) {
    add_graph(app, options.graph);
    add_frames(app, options.frames);
    add_running(app, options.running);
    add_layout(app, options.running);
    add_output(app, options.running.picture.output, "file of the picture, instead of the graph's");
    when_taken_apart(app, [&options] {
        const auto mistake = mistaken_scene(options.graph.file, "to render it: lightnet render");
        if (mistake) return mistake;
        const auto layout = mistaken_layout(options.running);
        return layout ? layout : settle(options.running);
    });
    add_examples(app, {"lightnet run graphs/cornell.lua --samples 16 -o cornell.exr",
                       "lightnet run graphs/cornell.lua --local-workers 2",
                       "lightnet run graphs/film.lua --frames 1-48 -o film.####.exr"});
}

RunRequest request_of(const GraphOptions& graph, const RunningOptions& running, const Launcher& launcher) {
    Loaded loaded = validate_job(read_files(graph, running.hosts), running.picture, launcher.registry);
    if (!running.layout.empty()) loaded = laid_out(running, launcher, std::move(loaded));
    return request_of(running, launcher, std::move(loaded));
}

// The picture of a frame that nobody has named: "shot.####.exr" of "shot.lua".
std::string usual_picture(const std::string& graph) { return stem_of_pictures(graph) + ".####.exr"; }

// A still is the first frame of what might be more.
RunRequest still_of(const RunOptions& options, const Launcher& launcher) {
    RunRequest request = request_of(options.graph, options.running, launcher);
    if (options.running.picture.output.empty()) request.output = with_frame(request.output, GraphFrame{}.number);
    return request;
}

// What --frames says of a graph, which -D can't.
GraphOptions graph_of_frames(const RunOptions& options) {
    GraphOptions graph = taken_from_standard_input(options.graph);
    if (graph.constants.contains("frame"))
        throw UserError({"-D frame", 0}, "--frames says which frame it is; leave one of them out");
    if (options.frames.fps > 0) graph.constants["fps"] = number_text(options.frames.fps);
    return graph;
}

int run_graph(const RunOptions& options, const Launcher& launcher) {
    if (options.frames.numbers.empty()) return launcher.run(still_of(options, launcher));
    if (!options.running.layout.empty())
        throw UserError(
            {"--layout", 0},
            "is made of one picture; write it by --layout-out, and give that file to --hosts with --frames");
    auto graph = graph_of_frames(options);
    return run_frames(
        options.frames, options.running, launcher, [&](const GraphFrame& frame, const RunningOptions& running) {
            graph.frame = frame;
            RunRequest request = request_of(graph, running, launcher);
            const bool named =
                !running.picture.output.empty() || !film_of(request.graph, launcher.registry).file.empty();
            if (!named) request.output = usual_picture(graph.file);
            return request;
        });
}

}  // namespace

Verb run_verb() { return verb<RunOptions>("run", "render a graph", describe_run, run_graph); }

}  // namespace lightnet
