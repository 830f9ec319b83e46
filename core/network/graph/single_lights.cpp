#include "core/network/graph/single_lights.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "core/network/graph/graph_film.hpp"
#include "core/network/graph/lamp_groups.hpp"
#include "core/network/graph/plan.hpp"

namespace lightnet {
namespace {

/// Looks at one graph.
class Search {
public:
    Search(const Graph& graph, const Registry& registry)
        : graph_(graph),
          registry_(registry),
          renderer_(renderer_of(graph, registry)),
          edges_(edges_of(graph)),
          layers_(layers_of(graph, registry)) {}

    std::vector<SingleLight> run() const {
        std::vector<SingleLight> lights;
        if (!can_tell()) return lights;
        std::vector<std::size_t> nodes;
        for (const Terminal& terminal : layers_.of_node[renderer_]) nodes.push_back(terminal.node);
        nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
        for (const auto node : nodes)
            if (auto made = layers_made_of(node, layers_, graph_, registry_); !made.empty())
                lights.push_back(light_of(node, std::move(made)));
        return lights;
    }

private:
    const Kind& kind_of(std::size_t node) const { return *registry_.find(graph_.nodes[node].kind); }

    bool can_tell() const {
        const Kind& kind = kind_of(renderer_);
        const auto& params = graph_.nodes[renderer_].params;
        if (!kind.asks_by || kind.light.merges || !graph_.sectors.empty() || params.contains("layers") ||
            sampling_of(graph_, registry_).noise > 0)
            return false;
        const auto used = used_nodes(graph_, renderer_);
        for (std::size_t node = 0; node < used.size(); ++node)
            if (used[node] && kind_of(node).run.rehearses) return false;
        return true;
    }

    SingleLight light_of(std::size_t node, std::vector<std::size_t> layers) const {
        SingleLight light{node, std::move(layers), used_nodes(graph_, node), {}};
        auto way = on_the_way(node);
        Graph part;
        for (std::size_t i = 0; i < graph_.nodes.size(); ++i) {
            if (way[i])
                part.nodes.push_back(as_far_as(i, way, node));
            else if (light.used[i])
                part.nodes.push_back(graph_.nodes[i]);
        }
        for (Node& one : part.nodes) one.where = {};
        light.text = to_json(part);
        for (const auto& group : lamp_groups(graph_, registry_)) light.text += '\n' + group;
        light.text += any_by_pass() ? "\npasses" : "";
        way[renderer_] = false;
        for (std::size_t i = 0; i < way.size(); ++i)
            if (way[i]) light.used[i] = true;
        return light;
    }

    // Per node, whether it passes on that one's light as it is: the renderer, and linear ones.
    std::vector<bool> on_the_way(std::size_t node) const {
        std::vector<bool> way(graph_.nodes.size(), false);
        for (std::size_t i = 0; i < way.size(); ++i) {
            const auto& passed = layers_.of_node[i];
            way[i] = i != node && (i == renderer_ || kind_of(i).light.linear) &&
                     std::any_of(passed.begin(), passed.end(), [&](const auto& one) { return one.node == node; });
        }
        return way;
    }

    // One of those, with no other inputs, and without what changes none of its light.
    Node as_far_as(std::size_t index, const std::vector<bool>& way, std::size_t node) const {
        Node one = graph_.nodes[index];
        const Kind& kind = kind_of(index);
        std::vector<bool> stays;
        for (const auto input : edges_.inputs[index]) stays.push_back(way[input] || input == node);
        keep(one.entries, stays);
        for (const Param& param : kind.params) {
            const bool of_picture = param.type == ParamType::film || param.type == ParamType::nodes ||
                                    param.type == ParamType::scene || param.name == "samples" || param.name == "error";
            if (index == renderer_ && of_picture) one.params.erase(param.name);
            const auto given = one.params.find(param.name);
            if (!param.per_input || given == one.params.end()) continue;
            if (auto* table = std::get_if<Table>(&given->second.data); table && table->list.size() == stays.size())
                keep(table->list, stays);
        }
        return one;
    }

    static void keep(std::vector<Value>& values, const std::vector<bool>& stays) {
        std::vector<Value> left;
        for (std::size_t i = 0; i < values.size(); ++i)
            if (stays[i]) left.push_back(std::move(values[i]));
        values = std::move(left);
    }

    bool any_by_pass() const {
        const auto used = used_nodes(graph_, renderer_);
        for (std::size_t i = 0; i < used.size(); ++i)
            if (used[i] && kind_of(i).run.passes) return true;
        return false;
    }

    const Graph& graph_;
    const Registry& registry_;
    const std::size_t renderer_;
    const Edges edges_;
    const Layers layers_;
};

void leave_out(Node& node) {
    std::map<std::string, Value> params;
    for (const char* name : {"lamps", "groups"})
        if (auto param = node.params.extract(name)) params.insert(std::move(param));
    node = {node.name, left_out_kind, {}, std::move(params), node.where};
}

// Is it one whose light comes to the renderer as it is, by way of linear nodes?
bool passes_on(const Graph& graph, const Registry& registry, const Layers& layers, std::size_t node) {
    const Kind& kind = *registry.find(graph.nodes[node].kind);
    return kind.role == Role::image || (kind.light.linear && !layers.of_node[node].empty());
}

// Nodes whose light is still asked for by others than those that only pass it on.
std::vector<bool> asked_elsewhere(const Graph& graph, const Registry& registry, const std::vector<bool>& left_out) {
    const auto renderer = renderer_of(graph, registry);
    const Layers layers = layers_of(graph, registry);
    Graph rest = graph;
    for (std::size_t i = 0; i < rest.nodes.size(); ++i)
        if (left_out[i]) rest.nodes[i].entries.clear(), rest.nodes[i].params.clear();
    const auto used = used_nodes(rest, renderer);
    std::vector<bool> asked(graph.nodes.size(), false);
    const auto add = [&](std::size_t top, bool itself) {
        const auto below = used_nodes(graph, top);
        for (std::size_t i = 0; i < below.size(); ++i)
            if (below[i] && (itself || i != top)) asked[i] = true;
    };
    for (std::size_t i = 0; i < graph.nodes.size(); ++i)
        if (used[i] && !left_out[i] && !passes_on(graph, registry, layers, i)) add(i, false);
    for (const auto shown : layers.shown) add(shown, true);
    return asked;
}

}  // namespace

std::vector<SingleLight> single_lights(const Graph& graph, const Registry& registry) {
    return Search(graph, registry).run();
}

Graph without_lights(const Graph& graph, const Registry& registry, std::vector<SingleLight>& known) {
    for (bool some = true; some;) {
        std::vector<bool> left_out(graph.nodes.size(), false);
        for (const auto& light : known) left_out[light.node] = true;
        const auto asked = asked_elsewhere(graph, registry, left_out);
        some = std::erase_if(known, [&](const SingleLight& light) { return asked[light.node]; }) > 0;
    }
    Graph rest = graph;
    for (const auto& light : known) leave_out(rest.nodes[light.node]);
    return rest;
}

Graph without_preparing(const Graph& graph, const Registry& registry) {
    Graph rest = graph;
    for (std::size_t node = 0; node < graph.nodes.size(); ++node) {
        const Kind& kind = *registry.find(graph.nodes[node].kind);
        if (kind.role != Role::light || kind.light.linear) continue;
        const auto below = used_nodes(graph, node);
        for (std::size_t i = 0; i < below.size(); ++i)
            if (below[i] && registry.find(graph.nodes[i].kind)->run.prepares) {
                leave_out(rest.nodes[node]);
                break;
            }
    }
    return rest;
}

bool leaves_out(const Graph& graph) {
    return std::any_of(graph.nodes.begin(), graph.nodes.end(),
                       [](const Node& node) { return node.kind == left_out_kind; });
}

}  // namespace lightnet
