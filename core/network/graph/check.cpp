#include "core/network/graph/check.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <tuple>

#include "core/base/in_quotes.hpp"
#include "core/base/problem_list.hpp"
#include "core/network/graph/check_hosts.hpp"
#include "core/network/graph/check_params.hpp"
#include "core/network/graph/cleaning.hpp"
#include "core/network/graph/graph_film.hpp"
#include "core/network/graph/lamp_groups.hpp"
#include "core/network/graph/layout.hpp"
#include "core/network/graph/light_paths.hpp"
#include "core/network/graph/plan.hpp"

namespace lightnet {
namespace {

std::string count_text(std::size_t count) { return std::to_string(count) + (count == 1 ? " input" : " inputs"); }

/// Looks at one graph, and collects what is wrong with it.
class Examination {
public:
    Examination(const Graph& graph, const Registry& registry)
        : given_(graph), registry_(registry), edges_(edges_of(graph)) {
        for (const auto& node : graph.nodes) names_.push_back(node.name);
        for (const auto& kind : registry.kinds()) kinds_.push_back(kind.name);
    }

    /// The graph with defaults, and what is wrong with it.
    Examined run() {
        found_.graph = given_;
        check_names();
        for (std::size_t node = 0; node < given_.nodes.size(); ++node) check_node(node);
        check_cycles();
        check_ranks();
        check_renderers();
        found_.problems = problems_.take();
        if (found_.problems.empty()) found_.problems = mistaken_groups(found_.graph, registry_);
        if (found_.problems.empty()) found_.problems = mistaken_layers(found_.graph, registry_);
        if (found_.problems.empty()) check_gains();
        if (found_.problems.empty()) found_.problems = add_cleaning(found_.graph, registry_);
        return std::move(found_);
    }

private:
    void complain(const Node& node, const std::string& what) {
        problems_.add(node.where, node.kind + " " + in_quotes(node.name) + ": " + what);
    }

    void check_names() {
        std::map<std::string, const Node*> seen;
        for (const auto& node : given_.nodes) {
            if (!is_name(node.name)) complain(node, name_rule);
            const auto [first, added] = seen.emplace(node.name, &node);
            if (!added)
                complain(node, "the name is taken by the " + first->second->kind + " of line " +
                                   std::to_string(first->second->where.line));
            if (node.name == "emission")
                complain(node, "the name is reserved for the layer of light that the renderer sees itself");
        }
    }

    // Which layers there are is known when all the rest is sound.
    void check_gains() {
        const auto& gains = film_of(found_.graph, registry_).gains;
        const Node& renderer = found_.graph.nodes[renderer_of(found_.graph, registry_)];
        for (const auto& mistake : mistakes_in(gains, layers_of(found_.graph, registry_).film))
            found_.problems.push_back(
                {renderer.where, renderer.kind + " " + in_quotes(renderer.name) + ": 'gains' of its film: " + mistake});
    }

    void check_node(std::size_t index) {
        Node& node = found_.graph.nodes[index];
        const Kind* kind = registry_.find(node.kind);
        const auto say = [&](const std::string& what) { complain(node, what); };
        if (!kind) say("unknown kind" + suggest(node.kind, kinds_));
        if (kind && kind->role == Role::scene)
            check_scene(node);
        else
            check_inputs(node, kind);
        if (kind) check_params(node, *kind, given_, say);
        if (kind) check_named_nodes(node, *kind);
    }

    // Nodes that parameters name: those whose frozen state is taken, and lists of those that are asked.
    void check_named_nodes(const Node& node, const Kind& kind) {
        for (const auto& param : kind.params) {
            const auto given = node.params.find(param.name);
            if (given == node.params.end()) continue;
            if (const auto* ref = std::get_if<NodeRef>(&given->second.data); ref && param.type == ParamType::node)
                check_taken(node, param, ref->name);
            const auto* list = std::get_if<Table>(&given->second.data);
            if (!list || param.type != ParamType::nodes) continue;
            for (const auto& entry : list->list)
                if (const auto* ref = std::get_if<NodeRef>(&entry.data)) check_shown(node, param, ref->name);
        }
    }

    void check_taken(const Node& node, const Param& param, const std::string& name) {
        const auto other = given_.find(name);
        const Kind* gives = other ? registry_.find(given_.nodes[*other].kind) : nullptr;
        if (!gives || gives->run.freezes == param.choices.at(0)) return;
        std::string kinds;
        for (const auto& known : registry_.kinds())
            if (known.run.freezes == param.choices.at(0)) kinds += (kinds.empty() ? "" : " or ") + known.name;
        complain(node, in_quotes(param.name) + " must be a node that keeps " + param.choices.at(0) + " (" + kinds +
                           "), but " + in_quotes(name) + " is of kind " + gives->name);
    }

    void check_shown(const Node& node, const Param& param, const std::string& name) {
        const auto other = given_.find(name);
        if (!other)
            return complain(node,
                            in_quotes(param.name) + ": no node called " + in_quotes(name) + suggest(name, names_));
        const Kind* gives = registry_.find(given_.nodes[*other].kind);
        if (gives && gives->role != Role::light)
            complain(node, in_quotes(param.name) + " has " + in_quotes(name) + ", which gives no light");
    }

    void check_scene(const Node& node) {
        if (node.entries.size() != 1 || !std::holds_alternative<std::string>(node.entries[0].data))
            complain(node, "takes the name of one file: Scene { \"file.pbrt\" }");
    }

    // Of an unknown kind nothing is known but that its inputs must be there.
    void check_inputs(const Node& node, const Kind* kind) {
        for (std::size_t i = 0; i < node.entries.size(); ++i) check_input(node, i, kind);
        if (!kind) return;
        const std::size_t count = node.entries.size();
        if (count < kind->inputs.least)
            complain(node, "needs at least " + count_text(kind->inputs.least) + ", has " + std::to_string(count));
        if (count > kind->inputs.most)
            complain(node, kind->inputs.most == 0
                               ? "takes no inputs, has " + std::to_string(count)
                               : "takes at most " + count_text(kind->inputs.most) + ", has " + std::to_string(count));
    }

    void check_input(const Node& node, std::size_t index, const Kind* kind) {
        const Value& entry = node.entries[index];
        const std::string which = "input " + std::to_string(index + 1);
        const auto* ref = std::get_if<NodeRef>(&entry.data);
        if (!ref) return complain(node, which + " is " + std::string(type_name(entry)) + ", but must be a node");
        const auto input = given_.find(ref->name);
        if (!input) return complain(node, "no node called " + in_quotes(ref->name) + suggest(ref->name, names_));
        const Kind* gives = registry_.find(given_.nodes[*input].kind);
        if (gives && gives->light.facts)
            return complain(node, which + ", " + in_quotes(ref->name) +
                                      ", gives facts about surfaces and no light: name it in the renderer's 'show'");
        if (!kind || !gives || gives->role == Role::light) return;
        const std::string hint = gives->role == Role::scene ? " (write scene = " + ref->name + ")" : "";
        complain(node, which + ", " + in_quotes(ref->name) + ", gives " +
                           (gives->role == Role::image ? "an image" : "a scene") + ", but light is wanted" + hint);
    }

    // Depth first; a node that is met again on the way to itself closes a cycle, which is told once.
    void check_cycles() {
        state_.assign(given_.nodes.size(), State::fresh);
        for (std::size_t node = 0; node < given_.nodes.size(); ++node)
            if (state_[node] == State::fresh) follow(node);
    }

    // By hand instead of by recursion: a long chain of nodes mustn't cost the stack.
    void follow(std::size_t start) {
        std::vector<std::pair<std::size_t, std::vector<std::size_t>>> path;
        const auto enter = [&](std::size_t node) {
            state_[node] = State::open;
            path.emplace_back(node, edges_.needed[node]);
            std::reverse(path.back().second.begin(), path.back().second.end());
        };
        enter(start);
        while (!path.empty()) {
            auto& [node, left] = path.back();
            if (left.empty()) {
                state_[node] = State::done;
                path.pop_back();
                continue;
            }
            const std::size_t input = left.back();
            left.pop_back();
            if (state_[input] == State::fresh)
                enter(input);
            else if (state_[input] == State::open)
                tell_cycle(path, input);
        }
    }

    void tell_cycle(const std::vector<std::pair<std::size_t, std::vector<std::size_t>>>& path, std::size_t closing) {
        const auto first =
            std::find_if(path.begin(), path.end(), [&](const auto& step) { return step.first == closing; });
        std::string names;
        for (auto step = first; step != path.end() && names.size() < ProblemList::longest; ++step)
            names += given_.nodes[step->first].name + " → ";
        complain(given_.nodes[closing], "asks itself: " + names + given_.nodes[closing].name);
    }

    // Of the nodes that stand too high the lowest is named, not all above it.
    void check_ranks() {
        std::vector<unsigned> ranks(given_.nodes.size(), 0);
        for (const auto node : leaves_first(edges_)) {
            for (const auto needed : edges_.needed[node]) ranks[node] = std::max(ranks[node], ranks[needed] + 1);
            if (ranks[node] == most_rank + 1)
                return complain(given_.nodes[node], "too many nodes ask each other in a row below it: at most " +
                                                        std::to_string(most_rank) + " can");
        }
    }

    void check_renderers() {
        const Node* first = nullptr;
        bool unknown = false;
        for (const auto& node : given_.nodes) {
            const Kind* kind = registry_.find(node.kind);
            unknown = unknown || !kind;
            if (!kind || kind->role != Role::image) continue;
            if (first) complain(node, "a second renderer; " + in_quotes(first->name) + " makes the image already");
            if (!first) first = &node;
        }
        // an unknown kind may well be the renderer, misspelt
        if (!first && !unknown) problems_.add({given_.file, 0}, "no renderer" + renderers_text());
    }

    std::string renderers_text() const {
        std::string text;
        for (const auto& kind : registry_.kinds())
            if (kind.role == Role::image) text += (text.empty() ? "" : " or ") + kind.name;
        return text.empty() ? "" : ": one node must make the image, a " + text;
    }

    enum class State { fresh, open, done };

    const Graph& given_;
    const Registry& registry_;
    const Edges edges_;
    std::vector<std::string> names_, kinds_;
    std::vector<State> state_;
    ProblemList problems_;
    Examined found_;
};

std::vector<Problem> unused_nodes(const Graph& graph, const Registry& registry) {
    std::vector<Problem> warnings;
    for (std::size_t node = 0; node < graph.nodes.size(); ++node) {
        if (registry.find(graph.nodes[node].kind)->role != Role::image) continue;
        const auto used = used_nodes(graph, node);
        for (std::size_t other = 0; other < used.size(); ++other)
            if (const auto& [name, kind, entries, params, where] = graph.nodes[other]; !used[other])
                warnings.push_back({where, kind + " " + in_quotes(name) + ": the image doesn't need it"});
    }
    return warnings;
}

}  // namespace

std::vector<Problem> irreproducible_nodes(const Graph& graph, const Registry& registry) {
    std::vector<Problem> warnings;
    for (const auto& node : graph.nodes)
        if (const Kind* kind = registry.find(node.kind); kind && !kind->run.reproducible)
            warnings.push_back({node.where, node.kind + " " + in_quotes(node.name) +
                                                ": draws random numbers that can't be seeded, so another run gives "
                                                "other bytes"});
    return warnings;
}

void sort_by_line(std::vector<Problem>& problems, const std::string& first_file) {
    const auto key = [&](const Problem& problem) {
        return std::tuple(problem.where.file != first_file, problem.where.file, problem.where.line);
    };
    std::stable_sort(problems.begin(), problems.end(),
                     [&](const Problem& a, const Problem& b) { return key(a) < key(b); });
}

namespace {

// First of all, as everything else takes the longer the more there is.
std::optional<Problem> too_large(const Graph& graph) {
    const auto at_most = [&](std::size_t most, const std::string& what, std::size_t count) {
        return Problem{
            {graph.file, 0},
            "a graph has at most " + std::to_string(most) + what + ", this one has " + std::to_string(count)};
    };
    // DECISIONS: graph-limits
    if (const auto count = written_nodes(graph); count > most_nodes) return at_most(most_nodes, " nodes", count);
    if (!graph.sectors.empty()) return std::nullopt;  // those are copies; the graph as it was written comes next
    if (const auto count = references_in(graph); count > most_references)
        return at_most(most_references, " places where a node names another", count);
    return std::nullopt;
}

// What is wrong, without what is only worth knowing.
Examined problems_of(const Graph& graph, const Registry& registry, const Hosts& hosts) {
    if (auto problem = too_large(graph)) return {graph, {std::move(*problem)}, {}, {}};
    if (!graph.sectors.empty()) {
        Examined found = problems_of(written(graph), registry, hosts);
        if (found.problems.empty()) found.graph = sharded(std::move(found.graph), shards_in(graph));
        return found;
    }
    Examined found = Examination(graph, registry).run();
    check_hosts(hosts, graph, registry, found.problems);
    sort_by_line(found.problems, graph.file);
    return found;
}

}  // namespace

Examined examine(const Graph& graph, const Registry& registry, const Hosts& hosts) {
    Examined found = problems_of(graph, registry, hosts);
    if (!found.problems.empty()) return found;
    const Graph sound = written(found.graph);
    found.warnings = unused_nodes(sound, registry);
    std::ranges::move(irreproducible_nodes(sound, registry), std::back_inserter(found.warnings));
    PathReport paths = report_paths(sound, registry);
    found.warnings.insert(found.warnings.end(), paths.doubles.begin(), paths.doubles.end());
    sort_by_line(found.warnings, graph.file);
    found.notes = std::move(paths.missing);
    return found;
}

Graph check(const Graph& graph, const Registry& registry, const Hosts& hosts) {
    Examined found = problems_of(graph, registry, hosts);
    if (!found.problems.empty()) throw UserError(std::move(found.problems));
    return std::move(found.graph);
}

}  // namespace lightnet
