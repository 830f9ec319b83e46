#include "core/network/graph/light_paths.hpp"

#include <algorithm>
#include <map>
#include <optional>

#include "core/base/in_quotes.hpp"
#include "core/network/graph/graph_film.hpp"
#include "core/network/graph/lamp_groups.hpp"
#include "core/network/graph/plan.hpp"

namespace lightnet {
namespace {

/// Paths that arrive from one node, by one way of being passed on.
struct Share {
    PathSet paths;
    std::string who;              // "'direct'", "'bounce' of 'direct'"
    int times = 1;                // how often it arrives; 2 stands for more as well
    bool part = false;            // of all that light: who divided it knows why
    bool known = true;            // its paths are stated
    std::size_t origin;           // the node that it comes from
    GroupSet lamps = all_groups;  // of which lamps it is
};
using Shares = std::vector<Share>;

constexpr std::size_t many_shares = 64;  // of one node; a graph with more is past being told in pairs

/// What arrives at one node. What comes by several ways from the same node in the same manner is one share that is
/// there several times.
class Gathered {
public:
    void add(Share share) {
        const auto [known, added] = at_.emplace(std::pair(share.who, share.part), all_.size());
        if (!added)
            all_[known->second].times = 2;
        else if (all_.size() < many_shares)
            all_.push_back(std::move(share));
        else
            at_.erase(known);
    }
    Shares take() { return std::move(all_); }

private:
    std::map<std::pair<std::string, bool>, std::size_t> at_;  // in all_, by who and part
    Shares all_;
};

class Book {
public:
    Book(const Graph& graph, const Registry& registry)
        : graph_(graph),
          registry_(registry),
          groups_(lamp_groups(graph, registry)),
          edges_(edges_of(graph)),
          of_(graph.nodes.size()) {}

    /// Node by node from the leaves up, so that a long chain of nodes doesn't cost the stack.
    const Shares& of(std::size_t top) {
        const auto used = used_nodes(graph_, top);
        for (const std::size_t node : leaves_first(edges_))
            if (used[node] && kind_of(node).role != Role::scene) of_[node] = own_and_inputs(node);
        return of_[top];
    }
    /// After of(): what arrives at a node that it has met.
    const Shares& met_at(std::size_t node) const { return of_[node]; }

private:
    const Kind& kind_of(std::size_t node) const { return *registry_.find(graph_.nodes[node].kind); }

    Shares own_and_inputs(std::size_t index) const {
        const Node& node = graph_.nodes[index];
        const Kind& kind = kind_of(index);
        const auto& inputs = edges_.inputs[index];
        const bool passes = kind.light.linear || kind.light.onward;
        Gathered shares;
        const GroupSet lamps = kind.light.lamps ? groups_wanted(node, groups_) : all_groups;
        if (kind.light.paths)
            for (const auto& text = kind.light.paths(node); const auto& own : text)
                shares.add({PathSet::parse(own), in_quotes(node.name), 1, false, true, index, lamps});
        if ((!kind.light.paths && !passes && !kind.light.converts) || (!inputs.empty() && !passes))
            shares.add({{}, in_quotes(node.name), 1, false, false, index});
        if (kind.light.converts)
            for (const std::size_t taken : edges_.taken[index])
                for (Share share : of_[taken]) {
                    share.who = in_quotes(node.name) + " from " + share.who;
                    shares.add(std::move(share));
                }
        if (passes) add_inputs(index, shares);
        return shares.take();
    }

    void add_inputs(std::size_t index, Gathered& shares) const {
        const Node& node = graph_.nodes[index];
        const Kind& kind = kind_of(index);
        const PathSet onward = PathSet::parse(kind.light.onward.value_or(""));
        const PassedOn passed = asks_where_it_is(kind) ? passed_on(kind, node) : PassedOn{};
        const auto& inputs = edges_.inputs[index];
        for (std::size_t i = 0; i < inputs.size(); ++i)
            for (Share share : of_[inputs[i]]) {
                if (!passed.ends.empty()) share.paths = share.paths.ending_in(passed.ends);
                share.paths = share.paths.then(onward);
                share.part = share.part || passed.part || weighted(node, kind, i);
                if (kind.light.onward && !kind.light.onward->empty() && kind.role == Role::light)
                    share.who = in_quotes(node.name) + " of " + share.who;
                shares.add(std::move(share));
            }
    }

    // Who gathers asks about other points than its own.
    static bool asks_where_it_is(const Kind& kind) {
        return kind.role == Role::light && kind.light.onward.value_or("").empty();
    }

    // Has the input a weight of its own?
    static bool weighted(const Node& node, const Kind& kind, std::size_t input) {
        for (const auto& param : kind.params) {
            if (!param.per_input || !node.params.contains(param.name)) continue;
            const auto* weights = std::get_if<Table>(&node.params.at(param.name).data);
            if (!weights || input >= weights->list.size()) continue;
            const auto* weight = std::get_if<double>(&weights->list[input].data);
            if (weight && *weight != 1) return true;
        }
        return false;
    }

    const Graph& graph_;
    const Registry& registry_;
    const std::vector<std::string> groups_;
    const Edges edges_;
    std::vector<Shares> of_;
};

/// Last letters of the paths that may reach the image from each node by linear ones.
class Ends {
public:
    Ends(const Graph& graph, const Registry& registry, std::size_t image) : of_(graph.nodes.size()) {
        const Edges edges = edges_of(graph);
        const auto order = leaves_first(edges);
        of_[image] = any;
        for (auto node = order.rbegin(); node != order.rend(); ++node) {
            const Kind& kind = *registry.find(graph.nodes[*node].kind);
            if (of_[*node].empty() || (*node != image && !kind.light.linear)) continue;
            const auto passed = *node == image ? PassedOn{} : passed_on(kind, graph.nodes[*node]);
            for (const auto input : edges.inputs[*node])
                for (const char letter : of_[*node])
                    if (passed.ends.empty() || passed.ends.find(letter) != passed.ends.npos) add(letter, of_[input]);
        }
    }
    PathSet of(const PathSet& paths, std::size_t node) const { return paths.ending_in(of_[node]); }

private:
    static void add(char letter, std::string& to) {
        if (to.find(letter) == to.npos) to += letter;
    }

    static constexpr const char* any = "OBSDV";
    std::vector<std::string> of_;  // by node
};

// Those that there are: one for all lamps, where nobody has sorted them.
GroupSet present(const std::vector<std::string>& groups) {
    return groups.empty() ? 1 : all_groups >> (most_groups - std::min(most_groups, groups.size()));
}

// " from lamps of 'key'": whose it is, where that is not all.
std::string whose(GroupSet lamps, const std::vector<std::string>& groups) {
    std::string text;
    bool all = true;
    for (std::size_t g = 0; g < groups.size(); ++g) {
        const bool is_in = lamps >> g & 1;
        all = all && is_in;
        if (is_in) text += (text.empty() ? "" : ", ") + in_quotes(groups[g]);
    }
    return all || text.empty() ? "" : " from lamps of " + text;
}

// The first share that a later one has a path in common with is named with it, and no third one: one mistake, one line.
void find_doubles(const Graph& graph, const Node& renderer, const std::vector<std::string>& groups,
                  const Shares& shares, std::vector<Problem>& problems) {
    const auto say = [&](const Share& share, const std::string& what) {
        const Node& node = graph.nodes[share.origin];
        problems.push_back(
            {node.where.line ? node.where : renderer.where, node.kind + " " + in_quotes(node.name) + ": " + what});
    };
    for (std::size_t i = 0; i < shares.size(); ++i) {
        const Share& later = shares[i];
        if (later.part) continue;
        if (later.times > 1 && !later.paths.empty())
            say(later, "light is counted more than once, as more than one way leads from it to the image: " +
                           *PathSet::common(later.paths, later.paths) + ", for one");
        for (std::size_t j = 0; j < i; ++j) {
            const GroupSet both = shares[j].lamps & later.lamps & present(groups);
            if (shares[j].part || !both) continue;
            if (const auto path = PathSet::common(shares[j].paths, later.paths)) {
                say(later, *path + whose(both, groups) + " is counted by " + shares[j].who + " and " + later.who);
                break;
            }
        }
    }
}

}  // namespace

// DECISIONS: light-paths-as-automata
PathReport report_paths(const Graph& graph, const Registry& registry) {
    const std::size_t image = renderer_of(graph, registry);
    Book book(graph, registry);
    const Shares& shares = book.of(image);
    const Node& renderer = graph.nodes[image];
    PathReport report;
    const auto groups = lamp_groups(graph, registry);
    const bool foggy = scene_of(graph, registry).params.contains("fog");  // media of files nobody has read yet
    find_doubles(graph, renderer, groups, shares, report.doubles);
    bool known = true, light = false;
    for (const Share& share : shares) {
        known = known && share.known;
        light = light || (share.origin != image && !share.paths.empty());
    }
    // An image of something else than light misses nothing.
    if (!known || !light) return report;
    std::map<std::string, GroupSet> missing;  // path, and whose
    for (std::size_t g = 0; g < std::max<std::size_t>(1, groups.size()); ++g) {
        PathSet all;
        for (const Share& share : shares)
            if (share.lamps >> g & 1) all = all.with(share.paths);
        if (const auto path = PathSet::missing(PathSet::parse(foggy ? "L(S|D|V)*E" : "L(S|D)*E"), all))
            missing[*path] |= GroupSet{1} << g;
    }
    for (const auto& [path, lamps] : missing)
        report.missing.push_back({renderer.where, renderer.kind + " " + in_quotes(renderer.name) + ": no node counts " +
                                                      path + whose(lamps, groups)});
    return report;
}

std::vector<ArrivingPaths> paths_at_image(const Graph& graph, const Registry& registry,
                                          const std::vector<std::size_t>& nodes) {
    const std::size_t image = renderer_of(graph, registry), groups = lamp_groups(graph, registry).size();
    Book book(graph, registry);
    book.of(image);
    const Ends ends(graph, registry, image);
    const PathSet onward = PathSet::parse(registry.find(graph.nodes[image].kind)->light.onward.value_or(""));
    std::vector<ArrivingPaths> all;
    for (const auto node : nodes) {
        ArrivingPaths& arriving = all.emplace_back();
        arriving.by_group.resize(std::max<std::size_t>(1, groups));
        for (const Share& share : book.met_at(node)) {
            if (node == image && share.origin != image) continue;
            arriving.known = arriving.known && share.known;
            for (std::size_t g = 0; g < arriving.by_group.size(); ++g)
                if (share.lamps >> g & 1)
                    arriving.by_group[g] = arriving.by_group[g].with(
                        node == image ? share.paths : ends.of(share.paths, node).then(onward));
        }
    }
    return all;
}

std::string paths_text(const Node& node, const Kind& kind) {
    std::string text;
    if (kind.light.paths)
        for (const auto& own : kind.light.paths(node)) text += (text.empty() ? "" : " and ") + own;
    if (kind.light.onward && !kind.light.onward->empty())
        text += (text.empty() ? "… " : " and … ") + *kind.light.onward;
    return text;
}

}  // namespace lightnet
