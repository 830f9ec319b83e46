#include "tools/watch/watch_json.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>

#include "core/base/json_tree.hpp"
#include "core/film/png.hpp"
#include "core/network/graph/hosts.hpp"
#include "core/network/graph/layout.hpp"
#include "core/network/graph/plan.hpp"
#include "core/run/assembly/gauge.hpp"

namespace lightnet {
namespace {

constexpr std::size_t most_rows = 100;
constexpr std::size_t most_in_flight = 400;

// The view of that name.
std::vector<std::size_t> view_of(const std::string& name, const FilmFormat& format) {
    const auto views = format.views();
    for (std::size_t k = 0; k < views.size(); ++k)
        if (format.name_of(views[k]) == name) return {k};
    return {};
}

// The colours of a pixel that, added up, are the picture of a node; none, if it has none.
std::vector<std::size_t> picture_of(std::size_t node, const Layers& layers, const WatchedRun& run) {
    std::vector<std::size_t> colours;
    const auto& film = layers.film;
    if (run.registry.find(run.graph.nodes[node].kind)->role == Role::image)
        for (std::size_t k = 0; k < film.size(); ++k) colours.push_back(k);
    const auto shown = std::find(layers.shown.begin(), layers.shown.end(), node);
    if (shown != layers.shown.end()) return view_of(run.graph.nodes[node].name, run.format);
    if (!colours.empty()) return colours;
    return layers_made_of(node, layers, run.graph, run.registry);
}

const char* name_of(Role role) { return role == Role::image ? "image" : role == Role::light ? "light" : "scene"; }

// What a page can change: numbers, and what is on or off.
JsonTree params_json(const Node& node) {
    auto all = JsonTree::object();
    for (const auto& [name, value] : node.params) {
        if (const auto* number = std::get_if<double>(&value.data)) all[name] = *number;
        if (const auto* flag = std::get_if<bool>(&value.data)) all[name] = *flag;
    }
    return all;
}

JsonTree nodes_json(const WatchedRun& run) {
    if (run.graph.nodes.empty()) return JsonTree::list();  // of a picture that nobody knows the graph of
    const auto layers = layers_of(run.graph, run.registry);
    auto all = JsonTree::list();
    for (std::size_t node = 0; node < run.graph.nodes.size(); ++node) {
        const auto& what = run.graph.nodes[node];
        if (sector_at(run.graph, node)) break;  // they stand behind all others, and for one of them
        all.push_back({{"name", what.name},
                       {"kind", what.kind},
                       {"role", name_of(run.registry.find(what.kind)->role)},
                       {"params", params_json(what)},
                       {"line", what.where.line},
                       {"picture", picture_of(node, layers, run)}});
    }
    return all;
}

JsonTree edges_json(const WatchedRun& run) {
    auto all = JsonTree::list();
    if (run.graph.nodes.empty()) return all;
    for (const auto& edge : asking_edges(run.graph, layers_of(run.graph, run.registry), run.registry))
        all.push_back({edge.from, edge.to});
    return all;
}

JsonTree row(const PlaceFigures& place) { return {place.busy, place.asking, place.waiting, place.idle}; }

JsonTree host_json(const HostState& host, bool by_place, bool in_words) {
    JsonTree json{{"name", host.name.empty() ? std::string(own_process) : host.name},
                  {"state", host.state},
                  {"there", host.there},
                  {"places", host.places},
                  {"answered", host.progress}};
    auto rows = JsonTree::list();
    PlaceFigures sum;
    for (const auto& place : host.figures.places) {
        if (by_place) rows.push_back(row(place));
        sum.busy += place.busy, sum.asking += place.asking;
        sum.waiting += place.waiting, sum.idle += place.idle;
    }
    if (!by_place) rows.push_back(row(sum));
    json["looks"] = std::move(rows);
    if (in_words) json["machine"] = host.machine.name, json["cpu"] = host.machine.cpu;
    return json;
}

// All hosts but those, as one.
JsonTree rest_json(const std::vector<HostState>& hosts, const std::set<std::size_t>& named) {
    HostState sum;
    std::size_t count = 0, gone = 0;
    auto& places = sum.figures.places.emplace_back();
    for (std::size_t i = 0; i < hosts.size(); ++i) {
        if (named.contains(i)) continue;
        ++count, gone += !hosts[i].there;
        sum.places += hosts[i].places, sum.progress += hosts[i].progress;
        for (const auto& place : hosts[i].figures.places) {
            places.busy += place.busy, places.asking += place.asking;
            places.waiting += place.waiting, places.idle += place.idle;
        }
    }
    sum.name = std::to_string(count) + " more hosts",
    sum.state = gone ? std::to_string(gone) + " are gone" : "are there";
    sum.there = gone < count;
    auto json = host_json(sum, false, false);
    json["rest"] = true;
    return json;
}

// DECISIONS: hosts-by-the-hundred
JsonTree hosts_json(const std::vector<HostState>& hosts) {
    std::size_t places = 0;
    for (const auto& host : hosts) places += host.places;
    std::set<std::size_t> named;
    const auto name = [&](bool there) {
        for (std::size_t i = 0; i < hosts.size() && named.size() < most_rows; ++i)
            if (hosts[i].there == there) named.insert(i);
    };
    name(false);
    name(true);
    auto all = JsonTree::list();
    for (const auto i : named) all.push_back(host_json(hosts[i], places <= most_rows, hosts.size() <= most_rows));
    if (named.size() < hosts.size()) all.push_back(rest_json(hosts, named));
    return all;
}

// Over all hosts. What sectors did, their node did.
void add_figures(JsonTree& json, const WatchedState& state, const Graph& graph) {
    std::vector<NodeFigures> nodes(graph.nodes.size());
    std::vector<EdgeFigures> edges;
    for (const auto& host : state.hosts) {
        const auto& figures = host.figures;
        for (std::size_t node = 0; node < std::min(nodes.size(), figures.nodes.size()); ++node)
            nodes[whole_of(graph, node)] += figures.nodes[node];
        edges.resize(std::max(edges.size(), figures.edges.size()));
        for (std::size_t edge = 0; edge < figures.edges.size(); ++edge) edges[edge] += figures.edges[edge];
    }
    auto& all = json["nodes"] = JsonTree::list();
    for (const auto& node : nodes)
        all.push_back(
            {node.looks, node.waiting, node.bundles, node.questions, node.bytes, node.nanoseconds, node.answered});
    auto& lines = json["edges"] = JsonTree::list();
    for (const auto& edge : edges) lines.push_back({edge.questions, edge.bundles, edge.sent, edge.bytes});
}

JsonTree forecast_json(const ForecastCurve& curve) {
    auto rows = JsonTree::list();
    for (const auto& [hosts, places, what] : curve.rows)
        rows.push_back({places, what.seconds, what.least * (1 - curve.doubt), what.most * (1 + curve.doubt),
                        what.efficiency, words_for(what.parts.front())});
    return {{"per_host", curve.per_host}, {"places", curve.places}, {"seconds", curve.seconds}, {"rows", rows}};
}

void add_viewed(JsonTree& hello, const Viewed& viewed) {
    hello["viewed"] = true;
    hello["facts"] = JsonTree::list();
    for (const auto& [what, text] : viewed.facts) hello["facts"].push_back({what, text});
    if (!viewed.other) return;
    const auto& other = *viewed.other;
    auto colours = JsonTree::list(), gains = JsonTree::list();
    for (const auto& colour : other.colours) colours.push_back(colour ? static_cast<int>(*colour) : -1);
    for (const Rgb& gain : other.gains) gains.push_back({gain.r, gain.g, gain.b});
    hello["other"] = {{"file", other.file}, {"beauty", other.beauty}, {"colours", colours}};
    hello["other"]["gains"] = other.gains.empty() ? JsonTree(nullptr) : std::move(gains);
}

}  // namespace

std::string hello_json(const WatchedRun& run, const Viewed* viewed) {
    const auto work = run.format.work();
    auto colours = JsonTree::list();
    for (const std::size_t k : run.format.views()) {
        const auto gain = k < run.format.gains.size() ? run.format.gains[k] : Rgb{1, 1, 1};
        const auto& name = run.format.name_of(k);
        colours.push_back({{"name", name},
                           {"layer", k < run.format.layers.size()},
                           {"fact", run.format.facts.contains(name)},
                           {"gain", {gain.r, gain.g, gain.b}}});
    }
    const auto levels = least_of_levels();
    JsonTree hello{{"graph", run.graph.file},
                   {"output", run.output},
                   {"picture", {work.x, work.y, work.width, work.height}},
                   {"samples", run.format.samples},
                   {"levels", std::vector(levels.begin(), levels.end())},
                   {"nodes", nodes_json(run)},
                   {"edited", run.edited},
                   {"edges", edges_json(run)}};
    if (run.format.halves()) {
        hello["cleaned"] = run.format.views().size();
        for (const auto& layer : run.format.layers)
            colours.push_back({{"name", "clean." + layer}, {"layer", false}, {"fact", false}, {"gain", {1, 1, 1}}});
    }
    if (viewed) add_viewed(hello, *viewed);
    if (run.frames) {
        auto all = JsonTree::list();
        for (const auto& [number, outcome] : run.frames->all) all.push_back({number, outcome});
        hello["frames"] = {{"at_work", run.frames->at_work}, {"all", std::move(all)}};
    }
    hello["colours"] = std::move(colours);
    return sorted_text({{"hello", std::move(hello)}});
}

std::string state_json(const WatchedState& state, const Graph& graph) {
    JsonTree json{{"t", std::round(state.seconds * 1000) / 1000},
                  {"phase", state.phase},
                  {"done", state.done},
                  {"outcome", state.outcome}};
    if (const auto& seen = state.viewpoint)
        json["camera"] = {{"from", {seen->from.x, seen->from.y, seen->from.z}},
                          {"to", {seen->to.x, seen->to.y, seen->to.z}},
                          {"up", {seen->up.x, seen->up.y, seen->up.z}},
                          {"fov", seen->fov}};
    if (state.parts) json["parts"] = *state.parts;
    if (!state.forecast.rows.empty()) json["forecast"] = forecast_json(state.forecast);
    for (const auto& move : state.moves) {
        auto& moves = json["moves"];
        if (&move == &state.moves.front()) moves = JsonTree::list();
        moves.push_back({{"seconds", move.seconds}, {"gain", move.gain}, {"nodes", move.nodes}});
    }
    if (state.left) json["left"] = std::round(*state.left * 10) / 10;
    json["hosts"] = hosts_json(state.hosts);
    add_figures(json, state, graph);
    auto& tiles = json["tiles"] = JsonTree::list();
    for (std::size_t i = 0; i < std::min(state.in_flight.size(), most_in_flight); ++i) {
        const auto& tile = state.in_flight[i];
        tiles.push_back({tile.x, tile.y, tile.width, tile.height});
    }
    auto& doing = json["doing"] = JsonTree::object();
    for (const auto& [node, what] : state.doing) doing[node] = {what.what, what.done, what.total};
    return sorted_text(json);
}

}  // namespace lightnet
