#include "core/network/graph/lamp_groups.hpp"

#include <algorithm>

#include "core/base/in_quotes.hpp"
#include "core/network/graph/check_params.hpp"
#include "core/network/graph/graph_film.hpp"

namespace lightnet {
namespace {

using Names = std::vector<std::string>;

const Value* param_of(const Node& node, const char* name) {
    const auto found = node.params.find(name);
    return found == node.params.end() ? nullptr : &found->second;
}

/// Looks at one graph, and collects what is wrong with its groups.
class GroupsCheck {
public:
    GroupsCheck(const Graph& graph, const Registry& registry)
        : graph_(graph), registry_(registry), groups_(lamp_groups(graph, registry)) {}

    std::vector<Problem> run() {
        check_scene();
        const auto keep = keep_groups(graph_, registry_);
        const Edges edges = edges_of(graph_);
        for (std::size_t node = 0; node < graph_.nodes.size(); ++node) {
            check_wanted(graph_.nodes[node]);
            if (asks_for_groups(graph_.nodes[node])) check_kept(graph_.nodes[node], edges.inputs[node], keep);
        }
        return std::move(problems_);
    }

private:
    void complain(const Node& node, const std::string& what) {
        problems_.push_back({node.where, node.kind + " " + in_quotes(node.name) + ": " + what});
    }

    // Gains name layers by their node and by their group, so one word can't mean both.
    void check_scene() {
        const Node& scene = scene_of(graph_, registry_);
        if (groups_.size() > most_groups)
            complain(scene, "has " + std::to_string(groups_.size() - 1) + " groups, but at most " +
                                std::to_string(most_groups - 1) + " can be");
        for (std::size_t i = 0; i + 1 < groups_.size(); ++i) {
            const std::string what = "'groups': " + in_quotes(groups_[i]);
            if (!is_name(groups_[i])) complain(scene, what + ": " + name_rule);
            if (groups_[i] == rest_of_lamps) complain(scene, what + " is the group of what no other one names");
            if (groups_[i] == "emission" || graph_.find(groups_[i]))
                complain(scene, what + " is the name of " + (groups_[i] == "emission" ? "a layer" : "a node") +
                                    " already: call the group something else");
            const auto& given = std::get<Table>(scene.params.at("groups").data).named;
            if (names_in(given.at(groups_[i])).empty()) complain(scene, what + " names no lamp");
        }
    }

    void check_wanted(const Node& node) {
        const Value* wanted = param_of(node, "lamps");
        if (!wanted) return;
        for (const auto& name : names_in(*wanted)) {
            if (groups_.empty()) return complain(node, "'lamps': " + none());
            if (std::find(groups_.begin(), groups_.end(), name) == groups_.end())
                complain(node, "'lamps': the scene has no group " + in_quotes(name) + suggest(name, groups_));
        }
    }

    void check_kept(const Node& node, const std::vector<std::size_t>& inputs, const std::vector<bool>& keep) {
        if (groups_.empty()) return complain(node, "'groups': " + none());
        if (registry_.find(node.kind)->role == Role::image) return;
        for (const auto input : inputs)
            if (!keep[input])
                complain(node, "keeps groups of lamps apart, but its input " + in_quotes(graph_.nodes[input].name) +
                                   " does not: write groups = true there, and where that gets its light from");
    }

    static std::string none() {
        return "the scene has no groups of lamps: write Scene { …, groups = { key = \"spot*\" } }, with names of lamps "
               "that `lightnet scene info` tells";
    }

    const Graph& graph_;
    const Registry& registry_;
    const Names groups_;
    std::vector<Problem> problems_;
};

}  // namespace

std::vector<std::string> names_in(const Value& value) {
    if (const auto* one = std::get_if<std::string>(&value.data)) return {*one};
    Names names;
    if (const auto* table = std::get_if<Table>(&value.data))
        for (const auto& entry : table->list)
            if (const auto* name = std::get_if<std::string>(&entry.data)) names.push_back(*name);
    return names;
}

std::vector<std::string> lamp_groups(const Graph& graph, const Registry& registry) {
    const auto renderer = std::find_if(graph.nodes.begin(), graph.nodes.end(), [&](const Node& node) {
        const Kind* kind = registry.find(node.kind);
        return kind && kind->role == Role::image;
    });
    if (renderer == graph.nodes.end()) return {};
    const Value* scene = param_of(*renderer, "scene");
    const auto* ref = scene ? std::get_if<NodeRef>(&scene->data) : nullptr;
    const auto found = ref ? graph.find(ref->name) : std::nullopt;
    const Value* given = found ? param_of(graph.nodes[*found], "groups") : nullptr;
    const auto* table = given ? std::get_if<Table>(&given->data) : nullptr;
    if (!table || table->named.empty()) return {};
    Names names;
    for (const auto& [name, lamps] : table->named) names.push_back(name);
    names.emplace_back(rest_of_lamps);
    return names;
}

GroupSet groups_wanted(const Node& node, const std::vector<std::string>& groups) {
    const Value* wanted = param_of(node, "lamps");
    GroupSet set = 0;
    if (wanted)
        for (const auto& name : names_in(*wanted))
            for (std::size_t g = 0; g < std::min(groups.size(), most_groups); ++g)
                if (groups[g] == name) set |= GroupSet{1} << g;
    return set ? set : all_groups;
}

bool asks_for_groups(const Node& node) {
    const Value* asked = param_of(node, "groups");
    const auto* flag = asked ? std::get_if<bool>(&asked->data) : nullptr;
    return flag && *flag;
}

std::vector<bool> keep_groups(const Graph& graph, const Registry& registry) {
    std::vector<bool> keep(graph.nodes.size(), false);
    if (lamp_groups(graph, registry).empty()) return keep;
    const Edges edges = edges_of(graph);
    for (const auto node : leaves_first(edges)) {
        const auto& inputs = edges.inputs[node];
        const bool linear = registry.find(graph.nodes[node].kind)->light.linear;
        keep[node] = linear
                         ? !inputs.empty() && std::all_of(inputs.begin(), inputs.end(), [&](auto i) { return keep[i]; })
                         : asks_for_groups(graph.nodes[node]);
    }
    return keep;
}

std::vector<Problem> mistaken_groups(const Graph& graph, const Registry& registry) {
    return GroupsCheck(graph, registry).run();
}

}  // namespace lightnet
