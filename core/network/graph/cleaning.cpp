#include "core/network/graph/cleaning.hpp"

#include <algorithm>
#include <array>

#include "core/base/in_quotes.hpp"
#include "core/film/clean_layers.hpp"
#include "core/network/graph/check_params.hpp"
#include "core/network/graph/plan.hpp"

namespace lightnet {
namespace {

constexpr const char* feature_kind = "SurfaceFeature";

// "clean_albedo": the albedo.
std::string fact_of(const std::string& layer) { return layer.substr(layer.find('_') + 1); }

Node feature_node(const std::string& name, const Node& renderer, const Kind& kind) {
    Node node{name, feature_kind, {}, {}, renderer.where};
    for (const auto& param : kind.params)
        if (param.initial) node.params[param.name] = *param.initial;
    node.params["of"] = Value{fact_of(name)};
    return node;
}

}  // namespace

bool wants_cleaning(const Graph& graph, const Registry& registry) {
    const Node& renderer = graph.nodes[renderer_of(graph, registry)];
    for (const auto& param : registry.find(renderer.kind)->params) {
        if (param.type != ParamType::film) continue;
        const auto given = renderer.params.find(param.name);
        if (given == renderer.params.end()) continue;
        const auto& film = std::get<Table>(given->second.data).named;
        const auto clean = film.find("clean");
        return clean != film.end() && std::get<bool>(clean->second.data);
    }
    return false;
}

std::vector<Problem> add_cleaning(Graph& graph, const Registry& registry) {
    if (!wants_cleaning(graph, registry)) return {};
    const std::size_t renderer = renderer_of(graph, registry);
    const auto wrong = [&](const std::string& what) {
        const Node& node = graph.nodes[renderer];
        return std::vector<Problem>{
            {node.where, node.kind + " " + in_quotes(node.name) + ": 'clean' of its film: " + what}};
    };
    const Kind* kind = registry.find(feature_kind);
    const auto& params = registry.find(graph.nodes[renderer].kind)->params;
    const auto shows = std::find_if(params.begin(), params.end(), [](const auto& p) { return p.name == "show"; });
    if (!kind || shows == params.end()) return wrong("its kind shows nothing of surfaces, which cleaning goes by");
    for (const auto& name : cleaning::feature_layers()) {
        if (const auto there = graph.find(name)) {
            if (graph.nodes[*there].kind != feature_kind)
                return wrong("the name " + in_quotes(name) + " is reserved for a " + feature_kind + ", but line " +
                             std::to_string(graph.nodes[*there].where.line) + " takes it");
        } else {
            graph.nodes.push_back(feature_node(name, graph.nodes[renderer], *kind));
        }
        auto& shown =
            std::get<Table>(graph.nodes[renderer].params.try_emplace("show", Value{Table{}}).first->second.data).list;
        const auto same = [&](const Value& entry) {
            const auto* ref = std::get_if<NodeRef>(&entry.data);
            return ref && ref->name == name;
        };
        if (std::none_of(shown.begin(), shown.end(), same)) shown.push_back({NodeRef{name}});
    }
    return {};
}

}  // namespace lightnet
