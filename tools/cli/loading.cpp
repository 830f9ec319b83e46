#include "tools/cli/loading.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <limits>
#include <ostream>
#include <utility>

#include "core/base/allowance.hpp"
#include "core/base/between_commas.hpp"
#include "core/base/plain_file.hpp"
#include "core/network/graph/check.hpp"
#include "core/network/graph/check_hosts.hpp"
#include "core/network/graph/graph_film.hpp"
#include "lua/load_graph.hpp"
#include "tools/cli/overrides.hpp"
#include "tools/pictures/output_file.hpp"
#include "transport/address/resolver.hpp"

namespace lightnet {
namespace {

constexpr auto names_patience = std::chrono::seconds(3);  // for all names of a hosts file

bool can_be_read(const std::string& file) try {
    const PlainFile opened(file, std::numeric_limits<std::uint64_t>::max());
    return true;
} catch (const Error&) {
    return false;
}

// Scenes are read much later, perhaps elsewhere; that a file is there can be said at once.
void check_scene_files(const Graph& graph, std::vector<Problem>& problems) {
    for (const auto& node : graph.nodes) {
        if (node.kind != "Scene" || node.entries.size() != 1) continue;
        const auto check = [&](const Value& value) {
            const auto* path = std::get_if<std::string>(&value.data);
            if (!path) return;
            const std::string file = beside_graph(graph, *path);
            if (!can_be_read(file))
                problems.push_back({node.where, "Scene '" + node.name + "': can't read '" + file + "'"});
        };
        check(node.entries[0]);
        if (const auto around = node.params.find("environment"); around != node.params.end()) check(around->second);
    }
}

// What a graph wants to be written. Where the user said where the picture goes, the graph has no say.
void check_written_files(const Graph& graph, const Registry& registry, const PictureOptions& wanted,
                         std::vector<Problem>& problems) {
    const auto add = [&](const std::vector<Problem>& more) {
        problems.insert(problems.end(), more.begin(), more.end());
    };
    add(problems_of_kept_files(graph, registry));
    if (problems.empty() && wanted.output.empty())
        add(problems_of_picture(graph, output_file(graph, registry, wanted)));
}

// How many cores this process may use is known, unlike those of other hosts: so each of its entries has its number of
// places now.
void give_places_here(Hosts& hosts) {
    for (auto& entry : hosts.hosts)
        if (entry.is_here() && entry.places == 0) entry.places = static_cast<int>(usable_cores());
}

// A hosts file, or nothing but addresses: "tcp://a:7777,tcp://b:7777".
Hosts named_hosts(const std::string& text) {
    Hosts hosts;
    for (const auto& name : between_commas(text)) {
        if (!address_of(name)) return load_hosts(text);
        hosts.hosts.push_back({name, {}, 0, {text, 0}});
    }
    return hosts;
}

/// A graph as it was found, and what the hosts file says.
Written with_hosts(Graph graph, std::vector<Problem> problems, const std::string& hosts) {
    Written written{std::move(graph), {}, std::move(problems)};
    try {
        if (!hosts.empty()) written.hosts = named_hosts(hosts);
    } catch (const UserError& error) {
        written.problems.insert(written.problems.end(), error.problems().begin(), error.problems().end());
    }
    return written;
}

}  // namespace

GraphOptions taken_from_standard_input(GraphOptions graph) {
    if (graph.file != standard_input_word) return graph;
    graph.file = standard_input_name;
    graph.text = graph_from_standard_input();
    return graph;
}

Written read_files(const GraphOptions& wanted, const std::string& hosts) {
    const GraphOptions graph = taken_from_standard_input(wanted);
    const LuaOptions options{.constants = graph.constants, .frame = graph.frame};
    GraphFile file = graph.text ? read_graph_text(*graph.text, graph.file, options) : read_graph(graph.file, options);
    return with_hosts(std::move(file.graph), std::move(file.problems), hosts);
}

Written read_files(const GraphOptions& graph, GraphReader& reader, const Hosts& hosts) {
    GraphFile file = reader.read(graph.file, {.constants = graph.constants, .frame = graph.frame});
    return {std::move(file.graph), hosts, std::move(file.problems)};
}

Hosts read_hosts(const std::string& hosts) { return hosts.empty() ? Hosts{} : named_hosts(hosts); }

Written read_files(const RenderedScene& scene, const std::string& hosts) {
    RenderGraph made = render_graph(scene);
    return with_hosts(std::move(made.graph), std::move(made.problems), hosts);
}

Loaded validate_job(Written written, const PictureOptions& wanted, const Registry& registry) {
    auto& [graph, hosts, problems] = written;
    override_picture(graph, registry, wanted);
    Examined found = examine(graph, registry, hosts);
    problems.insert(problems.end(), found.problems.begin(), found.problems.end());
    check_scene_files(graph, problems);
    check_written_files(graph, registry, wanted, problems);
    sort_by_line(problems, graph.file);
    if (!problems.empty()) throw UserError(std::move(problems));
    give_places_here(hosts);
    return {std::move(found.graph), std::move(hosts), std::move(found.warnings), std::move(found.notes)};
}

// All of them together. A name server that doesn't answer proves nothing.
std::vector<Problem> unknown_names(const Hosts& hosts) {
    Resolver names;
    const auto end = std::chrono::steady_clock::now() + names_patience;
    for (const auto& entry : hosts.hosts)
        if (const auto address = address_of(entry.endpoint))
            names.look(address->host, std::chrono::steady_clock::now());
    std::vector<Problem> unknown;
    for (const auto& entry : hosts.hosts) {
        const auto address = address_of(entry.endpoint);
        if (!address) continue;
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
        const auto found = names.wait_for(address->host, std::max(left, std::chrono::milliseconds(0)));
        if (found.state == Whereabout::State::gone)
            unknown.push_back({entry.where, "place '" + entry.endpoint + "': " + found.why});
    }
    return unknown;
}

void warn(const std::vector<Problem>& warnings, std::ostream& err) {
    for (const auto& warning : warnings) err << "warning: " << to_string(warning) << '\n';
}

}  // namespace lightnet
