// lightnet session: renders a graph while it is edited.
#include <CLI/CLI.hpp>

#include <unistd.h>

#include <optional>
#include <string>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/frame_name.hpp"
#include "lua/graph_reader.hpp"
#include "tools/cli/launcher.hpp"
#include "tools/cli/loading.hpp"
#include "tools/cli/options.hpp"
#include "tools/cli/request_of.hpp"
#include "tools/words/command_line.hpp"

namespace lightnet {
namespace {

struct SessionOptions {
    GraphOptions graph;
    RunningOptions running;
    bool json = false;
};

// Options that belong to one picture.
std::optional<std::string> mistaken_options(const RunningOptions& running) {
    const auto refuse = [](const std::string& option) { return option + " is for one picture: use lightnet run"; };
    if (running.viewer || running.preview > 0) return refuse("--preview");
    if (running.resume) return refuse("--resume");
    if (!running.report.empty()) return refuse("--report");
    if (!running.trace.empty()) return refuse("--trace");
    if (!running.reference.empty()) return refuse("--reference");
    return std::nullopt;
}

void describe_session(CLI::App& app, SessionOptions& options) {
    add_graph(app, options.graph);
    add_running(app, options.running);
    add_output(app, options.running.picture.output, "file of the picture, instead of the graph's");
    app.add_flag("--json", options.json, "tell on standard output what happens, in lines of JSON");
    when_taken_apart(app, [&options] {
        auto mistake = mistaken_scene(options.graph.file, "to render it: lightnet render");
        if (options.graph.file == standard_input_word) mistake = "standard input has edits, so the graph is a file";
        if (!mistake) mistake = mistaken_options(options.running);
        return mistake ? mistake : settle(options.running);
    });
    add_examples(app, {"lightnet session graphs/cornell.lua -o now.exr",
                       "lightnet session graphs/cornell.lua --local-workers 2 --json"});
}

// Warnings are said by the session, once for each picture that has them.
RunRequest request_of(const SessionOptions& options, const Launcher& launcher, GraphReader& reader, const Hosts& hosts,
                      const GraphEdits& edits) {
    GraphOptions graph = options.graph;
    for (const auto& [name, value] : edits.constants) graph.constants.insert_or_assign(name, value);
    RunningOptions running = options.running;
    running.progress = ProgressMode::none;
    running.forget = true;
    Written written = read_files(graph, reader, hosts);
    apply(edits, launcher.registry, written.graph, written.problems);
    RunRequest request =
        request_of(running, launcher, validate_job(std::move(written), running.picture, launcher.registry));
    if (running.picture.output.empty()) request.output = with_frame(request.output, GraphFrame{}.number);
    return request;
}

int run_session(const SessionOptions& options, const Launcher& launcher) {
    GraphReader reader;
    const Hosts hosts = read_hosts(options.running.hosts);
    Session session;
    session.graph = options.graph.file;
    session.watch = options.running.watch;
    session.edits = STDIN_FILENO;
    session.events = options.json ? &launcher.out : nullptr;
    session.request = [&](const GraphEdits& edits) { return request_of(options, launcher, reader, hosts, edits); };
    return launcher.run_session(session);
}

}  // namespace

Verb session_verb() {
    return verb<SessionOptions>("session", "render a graph again and again, while it is edited", describe_session,
                                run_session);
}

}  // namespace lightnet
