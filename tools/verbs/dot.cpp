// lightnet dot: draws a graph, and where its nodes run.
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "core/network/graph/dot.hpp"
#include "core/network/graph/dot_moves.hpp"
#include "core/network/graph/layout.hpp"
#include "core/network/graph/plan.hpp"
#include "tools/cli/launcher.hpp"
#include "tools/cli/lay_out.hpp"
#include "tools/cli/loading.hpp"
#include "tools/cli/options.hpp"
#include "tools/forecast/forecast_hosts.hpp"
#include "tools/pictures/node_pictures.hpp"
#include "tools/support/exit_code.hpp"
#include "tools/words/command_line.hpp"

namespace lightnet {
namespace {

struct DotOptions {
    GraphOptions graph;
    std::string hosts;                     // file; "": none
    std::optional<std::uint32_t> threads;  // places of one process
    std::string pictures;                  // the EXR that shows what each node gives; "": none
    std::string layout;                    // report by which the hosts are given nodes; "": none
    std::vector<std::string> memory;       // of hosts, for that
    std::string moves;                     // report of a run that is shown with its moves; "": none
};

void describe_dot(CLI::App& app, DotOptions& options) {
    add_graph(app, options.graph);
    auto* const hosts = add_hosts(app, options.hosts);
    auto* const threads = add_threads(app, options.threads, "show what places of one process hold");
    threads->excludes(hosts);
    app.add_option("--pictures", options.pictures, "a picture of this graph: each node shows what it gave to it")
        ->type_name("PICTURE.exr");
    auto* const layout =
        app.add_option("--layout", options.layout, "deal the nodes out to the hosts by what they cost in this run")
            ->type_name("X.run.json")
            ->needs(hosts);
    app.add_option("--layout-memory", options.memory, "what a host may keep of what nodes prepare, or NAME=16G")
        ->type_name("SIZE")
        ->needs(layout);
    app.add_option("--moves", options.moves, "show who had what at the end of this run, and what had moved")
        ->type_name("X.run.json")
        ->excludes(hosts)
        ->excludes(threads);
    when_taken_apart(app,
                     [&options] { return mistaken_scene(options.graph.file, "to look at it: lightnet scene info"); });
    add_examples(app, {"lightnet dot graphs/paper/figure8.lua | dot -Tsvg > figure8.svg"});
}

// What hosts will offer isn't known before they are asked: at least what the file says of them.
std::vector<HostOffer> likely_offers(const DotOptions& options, const Hosts& hosts) {
    if (options.threads) return {{"", *options.threads}};
    std::vector<HostOffer> offers;
    for (const auto& host : hosts.hosts)
        if (!host.is_here()) offers.push_back({host.endpoint, static_cast<std::uint32_t>(std::max(host.places, 1))});
    if (offers.size() < hosts.hosts.size()) offers.insert(offers.begin(), {"", 1});  // its entries say how many places
    return offers;
}

// Says why, too, as comments.
void lay_out(const DotOptions& options, const Launcher& launcher, Loaded& loaded) {
    std::vector<ForecastHost> hosts;
    for (const auto& entry : loaded.hosts.hosts)
        hosts.push_back({entry.host(), static_cast<std::uint32_t>(std::max(entry.places, 1))});
    for (const auto& text : options.memory) limit_memory(hosts, text);
    const auto costs = costs_for(loaded.graph, launcher.registry, options.layout);
    const auto layout = place_nodes(costs, hosts, {});
    loaded.hosts = hosts_of(layout.holds, costs, hosts, std::move(loaded.hosts));
    for (const auto& reason : layout.why) launcher.out << "// " << reason << '\n';
}

int draw(const DotOptions& options, const Launcher& launcher) {
    const auto& registry = launcher.registry;
    Loaded loaded = validate_job(read_files(options.graph, options.hosts), {}, registry);
    warn(loaded.warnings, launcher.err);
    if (!options.layout.empty()) lay_out(options, launcher, loaded);
    const auto offers = likely_offers(options, loaded.hosts);
    std::map<std::string, std::string> pictures;
    if (!options.pictures.empty()) pictures = write_node_pictures(loaded.graph, registry, options.pictures);
    if (!options.moves.empty()) {
        const auto run = recorded_run_of(loaded.graph, registry, options.moves);
        launcher.out << with_moves(to_dot(loaded.graph, registry, &run.plan, {}, pictures), loaded.graph, run.plan,
                                   run.moves);
        return exit_code::done;
    }
    if (offers.empty()) {
        launcher.out << to_dot(loaded.graph, registry, nullptr, {}, pictures);
        return exit_code::done;
    }
    const Graph graph = sharded(loaded.graph, shards_of(loaded.graph, registry, loaded.hosts));
    const Plan where = plan(graph, registry, loaded.hosts, offers);
    launcher.out << to_dot(graph, registry, &where, {}, pictures);
    return exit_code::done;
}

}  // namespace

Verb dot_verb() { return verb<DotOptions>("dot", "print a graph as Graphviz DOT", describe_dot, draw); }

}  // namespace lightnet
