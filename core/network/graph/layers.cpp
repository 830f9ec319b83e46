// Layers of an image, and the node that keeps each of them apart.
#include <algorithm>
#include <cassert>

#include "core/film/clean_layers.hpp"
#include "core/network/graph/cleaning.hpp"
#include "core/network/graph/lamp_groups.hpp"
#include "core/network/graph/path_layers.hpp"
#include "core/network/graph/plan.hpp"

namespace lightnet {

std::size_t renderer_of(const Graph& graph, const Registry& registry) {
    for (std::size_t node = 0; node < graph.nodes.size(); ++node)
        if (const Kind* kind = registry.find(graph.nodes[node].kind); kind && kind->role == Role::image) return node;
    throw Error(graph.file, "no renderer");
}

namespace {

using Terminals = std::vector<Terminal>;

// Linear nodes and the renderer pass on what their inputs keep apart; all others are terminals themselves.
bool is_terminal(const Kind& kind) { return !kind.light.linear && kind.role == Role::light; }

// A node's own light, each group of lamps apart if it keeps them.
Terminals own_terminals(std::size_t node, const Layers& layers) {
    Terminals own;
    for (std::uint32_t g = 0; g < (layers.by_group[node] ? layers.groups : 1); ++g) own.push_back({node, g});
    return own;
}

/// Per node, the terminals below it, in graph order: for the nodes on additive paths from `top` only.
std::vector<Terminals> terminals_below(std::size_t top, const Graph& graph, const Registry& registry,
                                       const Layers& layers) {
    const Edges edges = edges_of(graph);
    const auto kind_of = [&](std::size_t node) -> const Kind& {
        const Kind* kind = registry.find(graph.nodes[node].kind);
        assert(kind && "only checked graphs have layers");
        return *kind;
    };
    std::vector<bool> additive(graph.nodes.size(), false);
    additive[top] = true;
    const auto order = leaves_first(edges);
    for (auto node = order.rbegin(); node != order.rend(); ++node)
        if (additive[*node] && !is_terminal(kind_of(*node)))
            for (const auto input : edges.inputs[*node]) additive[input] = true;
    std::vector<Terminals> below(graph.nodes.size());
    for (const auto node : order) {
        if (!additive[node]) continue;
        Terminals& all = below[node];
        if (is_terminal(kind_of(node)))
            all = own_terminals(node, layers);
        else
            for (const auto input : edges.inputs[node]) all.insert(all.end(), below[input].begin(), below[input].end());
        std::sort(all.begin(), all.end());
        all.erase(std::unique(all.begin(), all.end()), all.end());
    }
    return below;
}

// Which groups of lamps there are, and who keeps them apart.
Layers nameless_layers(const Graph& graph, const Registry& registry) {
    Layers layers;
    layers.groups = std::max<std::size_t>(1, lamp_groups(graph, registry).size());
    layers.by_group = keep_groups(graph, registry);
    return layers;
}

// Its own light, one colour for each group of lamps if it keeps them apart, and what it gathers.
Terminals colours_at(std::size_t renderer, const Layers& layers) {
    Terminals colours = own_terminals(renderer, layers);
    colours.insert(colours.end(), layers.of_node[renderer].begin(), layers.of_node[renderer].end());
    return colours;
}

// Each colour has a layer of its own, but what an expression puts together.
void name_layers(std::size_t renderer, const Graph& graph, const Registry& registry, Layers& layers) {
    const auto groups = lamp_groups(graph, registry);
    const auto colours = colours_at(renderer, layers);
    const auto given = path_layers(graph, registry, colours, layers.by_group).names;
    layers.emission = colours.size() - layers.of_node[renderer].size();
    for (std::size_t c = 0; c < colours.size(); ++c) {
        const auto [node, group] = colours[c];
        std::string name = given[c];
        if (name.empty()) {
            name = c < layers.emission ? "emission" : graph.nodes[node].name;
            if (layers.by_group[node]) name += "." + groups[group];
        }
        auto layer = std::find(layers.film.begin(), layers.film.end(), name);
        if (layer == layers.film.end()) layer = layers.film.insert(layer, name);
        layers.of_colour.push_back(static_cast<std::uint32_t>(layer - layers.film.begin()));
    }
}

bool says(const Node& node, const char* flag) {
    const auto found = node.params.find(flag);
    return found != node.params.end() && std::get<bool>(found->second.data);
}

void add_shown(std::size_t node, const Graph& graph, const Registry& registry, Layers& layers) {
    const bool ids = registry.find(graph.nodes[node].kind)->light.ids;
    layers.shown.push_back(node);
    layers.ids.push_back(ids ? static_cast<std::uint32_t>(std::get<double>(graph.nodes[node].params.at("ranks").data))
                             : 0);
}

// Of all layers, and of what is shown for cleaning.
void add_halves(const Graph& graph, Layers& layers) {
    for (std::size_t layer = 0; layer < layers.film.size(); ++layer)
        layers.halved.push_back(static_cast<std::uint32_t>(layer));
    for (std::size_t i = 0; i < layers.shown.size(); ++i)
        if (cleaning::is_for_cleaning(graph.nodes[layers.shown[i]].name))
            layers.halved.push_back(static_cast<std::uint32_t>(first_colour(layers, i)));
}

}  // namespace

std::size_t first_colour(const Layers& layers, std::size_t shown) {
    std::size_t colour = layers.film.size();
    for (std::size_t i = 0; i < shown; ++i) colour += std::max(1u, layers.ids[i]);
    return colour;
}

std::size_t colours_of(const Layers& layers) {
    return first_colour(layers, layers.shown.size()) + layers.halved.size() + layers.alpha;
}

Addition addition_of(const Layers& layers) {
    std::vector<IdColours> ids;
    for (std::size_t i = 0; i < layers.ids.size(); ++i)
        if (layers.ids[i]) ids.push_back({first_colour(layers, i), layers.ids[i]});
    return {colours_of(layers), std::move(ids)};
}

std::vector<std::string> shown_names(const Layers& layers, const Graph& graph) {
    std::vector<std::string> names;
    for (const std::size_t node : layers.shown) names.push_back(graph.nodes[node].name);
    for (const std::uint32_t colour : layers.halved) {
        if (colour < layers.film.size()) {
            names.push_back(cleaning::half_of(layers.film[colour]));
            continue;
        }
        for (std::size_t i = 0; i < layers.shown.size(); ++i)
            if (first_colour(layers, i) == colour) names.push_back(cleaning::half_of(names[i]));
    }
    return names;
}

std::string name_of(const Terminal& terminal, const Layers& layers, const Graph& graph, const Registry& registry) {
    const std::string& node = graph.nodes[terminal.node].name;
    return layers.by_group[terminal.node] ? node + "." + lamp_groups(graph, registry)[terminal.group] : node;
}

std::vector<std::size_t> layers_made_of(std::size_t node, const Layers& layers, const Graph& graph,
                                        const Registry& registry) {
    const auto colours = colours_at(renderer_of(graph, registry), layers);
    const auto& own = layers.of_node[node];
    std::vector<std::size_t> made_of;
    for (const auto& terminal : own) {
        const auto colour =
            std::find(colours.begin() + static_cast<std::ptrdiff_t>(layers.emission), colours.end(), terminal);
        if (colour == colours.end()) return {};
        made_of.push_back(layers.of_colour[static_cast<std::size_t>(colour - colours.begin())]);
    }
    std::sort(made_of.begin(), made_of.end());
    made_of.erase(std::unique(made_of.begin(), made_of.end()), made_of.end());
    for (std::size_t c = 0; c < layers.of_colour.size(); ++c)
        if (std::binary_search(made_of.begin(), made_of.end(), layers.of_colour[c]) &&
            (c < layers.emission || std::find(own.begin(), own.end(), colours[c]) == own.end()))
            return {};
    return made_of;
}

std::vector<Problem> mistaken_layers(const Graph& graph, const Registry& registry) {
    const std::size_t renderer = renderer_of(graph, registry);
    if (!graph.nodes[renderer].params.contains("layers")) return {};
    Layers layers = nameless_layers(graph, registry);
    layers.of_node = terminals_below(renderer, graph, registry, layers);
    return path_layers(graph, registry, colours_at(renderer, layers), layers.by_group).problems;
}

Layers layers_of(const Graph& graph, const Registry& registry) {
    const std::size_t renderer = renderer_of(graph, registry);
    Layers layers = nameless_layers(graph, registry);
    if (registry.find(graph.nodes[renderer].kind)->light.merges) {
        layers.film = {graph.nodes[renderer].name};
        layers.of_node.resize(graph.nodes.size());
        layers.of_colour = {0};
    } else {
        layers.of_node = terminals_below(renderer, graph, registry, layers);
        name_layers(renderer, graph, registry, layers);
    }
    for (const std::size_t shown : graph.shown_by(renderer)) {
        const auto is_there = [&](const auto& all, const auto& one) {
            return std::find(all.begin(), all.end(), one) != all.end();
        };
        if (!is_there(layers.film, graph.nodes[shown].name) && !is_there(layers.shown, shown))
            add_shown(shown, graph, registry, layers);
    }
    if (wants_cleaning(graph, registry)) add_halves(graph, layers);
    layers.alpha = says(graph.nodes[renderer], "alpha");
    // a node on no additive path answers with the light of all below it as its own
    for (std::size_t node = 0; node < graph.nodes.size(); ++node) {
        const Kind* kind = registry.find(graph.nodes[node].kind);
        if (layers.of_node[node].empty() && kind->role == Role::light)
            layers.of_node[node] = own_terminals(node, layers);
    }
    return layers;
}

}  // namespace lightnet
