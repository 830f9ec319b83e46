// lightnet check: tells everything that is wrong with a graph, its hosts and its scene.
#include <ostream>
#include <string>

#include "core/network/graph/graph_film.hpp"
#include "core/network/graph/layout.hpp"
#include "core/network/graph/plan.hpp"
#include "core/run/assembly/load_scene.hpp"
#include "tools/cli/launcher.hpp"
#include "tools/cli/loading.hpp"
#include "tools/cli/options.hpp"
#include "tools/support/exit_code.hpp"
#include "tools/words/command_line.hpp"

namespace lightnet {
namespace {

struct CheckOptions {
    GraphOptions graph;
    PictureOptions picture;
    std::string hosts;
};

void describe_check(CLI::App& app, CheckOptions& options) {
    add_graph(app, options.graph);
    add_picture(app, options.picture);
    add_hosts(app, options.hosts);
    when_taken_apart(app,
                     [&options] { return mistaken_scene(options.graph.file, "to look at it: lightnet scene info"); });
    add_examples(app, {"lightnet check graphs/paper/figure5.lua"});
}

void print_sound(const Loaded& loaded, const Registry& registry, std::ostream& out) {
    const auto format = film_of(loaded.graph, registry);
    out << loaded.graph.file << ": sound: " << loaded.graph.nodes.size() << " nodes, " << format.width << "x"
        << format.height;
    if (const auto& crop = format.crop) out << " (" << crop->width << "x" << crop->height << " of it)";
    out << ", layers";
    for (const auto& layer : layers_of(loaded.graph, registry).film) out << ' ' << layer;
    for (const auto& [node, count] : shards_of(loaded.graph, registry, loaded.hosts))
        out << ", " << node << " in " << count << " sectors";
    out << '\n';
}

int check_graph(const CheckOptions& options, const Launcher& launcher) {
    const auto& registry = launcher.registry;
    const Loaded loaded = validate_job(read_files(options.graph, options.hosts), options.picture, registry);
    warn(loaded.warnings, launcher.err);
    DiskFiles files;
    warn(load_scene(loaded.graph, registry, files, scene_file(loaded.graph, registry)).data.warnings, launcher.err);
    warn(unknown_names(loaded.hosts), launcher.err);
    for (const auto& note : loaded.notes) launcher.err << "note: " << to_string(note) << '\n';
    print_sound(loaded, registry, launcher.out);
    return exit_code::done;
}

}  // namespace

Verb check_verb() {
    return verb<CheckOptions>("check", "find everything that is wrong with a graph", describe_check, check_graph);
}

}  // namespace lightnet
