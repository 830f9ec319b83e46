// lightnet run: renders a graph.
#include <optional>
#include <utility>

#include "tools/cli/launcher.hpp"
#include "tools/cli/loading.hpp"
#include "tools/cli/options.hpp"
#include "tools/cli/request_of.hpp"
#include "tools/support/command_line.hpp"

namespace lightnet {
namespace {

struct RunOptions {
    GraphOptions graph;
    RunningOptions running;
};

void describe_run(CLI::App& app, RunOptions& options) {
    add_graph(app, options.graph);
    add_running(app, options.running);
    add_output(app, options.running.picture.output, "file of the picture, instead of the graph's");
    when_taken_apart(app, [&options] {
        const auto mistake = mistaken_scene(options.graph.file, "to render it: lightnet render");
        return mistake ? mistake : settle(options.running);
    });
    add_examples(app, {"lightnet run graphs/cornell.lua --samples 16 -o cornell.exr",
                       "lightnet run graphs/cornell.lua --local-workers 2"});
}

int run_graph(const RunOptions& options, const Launcher& launcher) {
    const auto& running = options.running;
    Loaded loaded = validate_job(read_files(options.graph, running.hosts), running.picture, launcher.registry);
    return launcher.run(request_of(running, launcher, std::move(loaded)));
}

}  // namespace

Verb run_verb() { return verb<RunOptions>("run", "render a graph", describe_run, run_graph); }

}  // namespace lightnet
