#include "core/graph/light_paths.hpp"

#include <algorithm>
#include <map>
#include <optional>

#include "core/graph/plan.hpp"

namespace lightnet {
namespace {

/// Paths that arrive from one node, by one way of being passed on.
struct Share {
    PathSet paths;
    std::string who;     // "'direct'", "'bounce' of 'direct'"
    int times = 1;       // how often it arrives; 2 stands for more as well
    bool part = false;   // of all that light: who divided it knows why
    bool known = true;   // its paths are stated
    std::size_t origin;  // the node that it comes from
};
using Shares = std::vector<Share>;

constexpr std::size_t many_shares = 64;  // of one node; a graph with more is past being told in pairs

class Book {
public:
    Book(const Graph& graph, const Registry& registry)
        : graph_(graph), registry_(registry), of_(graph.nodes.size()), done_(graph.nodes.size()) {}

    const Shares& of(std::size_t node) {
        if (!done_[node]) {
            of_[node] = together(own_and_inputs(node));
            done_[node] = true;
        }
        return of_[node];
    }

private:
    Shares own_and_inputs(std::size_t index) {
        const Node& node = graph_.nodes[index];
        const Kind& kind = *registry_.find(node.kind);
        const auto inputs = graph_.inputs_of(index);
        const bool passes = kind.linear || kind.onward;
        Shares shares;
        if (kind.paths)
            for (const auto& text = kind.paths(node); const auto& own : text)
                shares.push_back({PathSet::parse(own), quoted(node.name), 1, false, true, index});
        if ((!kind.paths && !passes && !kind.converts) || (!inputs.empty() && !passes))
            shares.push_back({{}, quoted(node.name), 1, false, false, index});
        if (kind.converts)
            for (const std::size_t taken : graph_.taken_by(index))
                for (Share share : of(taken)) {
                    share.who = quoted(node.name) + " from " + share.who;
                    shares.push_back(std::move(share));
                }
        if (!passes) return shares;
        const PathSet onward = PathSet::parse(kind.onward.value_or(""));
        for (std::size_t i = 0; i < inputs.size(); ++i)
            for (Share share : of(inputs[i])) {
                share.paths = share.paths.then(onward);
                share.part = share.part || kind.partial || weighted(node, kind, i);
                if (kind.onward && !kind.onward->empty() && kind.role == Role::light)
                    share.who = quoted(node.name) + " of " + share.who;
                shares.push_back(std::move(share));
            }
        return shares;
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

    // What arrives by several ways from the same node in the same manner is one share that is there several times.
    static Shares together(Shares shares) {
        std::map<std::pair<std::string, bool>, std::size_t> at;
        Shares all;
        for (Share& share : shares) {
            const auto [known, added] = at.emplace(std::pair(share.who, share.part), all.size());
            if (added && all.size() < many_shares)
                all.push_back(std::move(share));
            else if (!added && known->second < all.size())
                all[known->second].times = 2;
        }
        return all;
    }

    static std::string quoted(const std::string& text) { return "'" + text + "'"; }

    const Graph& graph_;
    const Registry& registry_;
    std::vector<Shares> of_;
    std::vector<bool> done_;
};

// The first share that a later one has a path in common with is named with it, and no third one: one mistake, one line.
void find_doubles(const Graph& graph, const Node& renderer, const Shares& shares, std::vector<Problem>& problems) {
    const auto say = [&](const Share& share, const std::string& what) {
        const Node& node = graph.nodes[share.origin];
        problems.push_back(
            {node.where.line ? node.where : renderer.where, node.kind + " '" + node.name + "': " + what});
    };
    for (std::size_t i = 0; i < shares.size(); ++i) {
        const Share& later = shares[i];
        if (later.part) continue;
        if (later.times > 1 && !later.paths.empty())
            say(later, "light is counted more than once, as more than one way leads from it to the picture: " +
                           *PathSet::common(later.paths, later.paths) + ", for one");
        for (std::size_t j = 0; j < i; ++j) {
            if (shares[j].part) continue;
            if (const auto path = PathSet::common(shares[j].paths, later.paths)) {
                say(later, *path + " is counted by " + shares[j].who + " and " + later.who);
                break;
            }
        }
    }
}

}  // namespace

PathReport report_paths(const Graph& graph, const Registry& registry) {
    const std::size_t image = renderer_of(graph, registry);
    Book book(graph, registry);
    const Shares& shares = book.of(image);
    const Node& renderer = graph.nodes[image];
    PathReport report;
    find_doubles(graph, renderer, shares, report.doubles);
    PathSet all;
    bool known = true, light = false;
    for (const Share& share : shares) {
        all = all.with(share.paths);
        known = known && share.known;
        light = light || (share.origin != image && !share.paths.empty());
    }
    // A picture of something else than light misses nothing.
    if (!known || !light) return report;
    if (const auto path = PathSet::missing(PathSet::parse("L(S|D)*E"), all))
        report.missing.push_back({renderer.where, renderer.kind + " '" + renderer.name + "': no node counts " + *path});
    return report;
}

std::string paths_text(const Node& node, const Kind& kind) {
    std::string text;
    if (kind.paths)
        for (const auto& own : kind.paths(node)) text += (text.empty() ? "" : " and ") + own;
    if (kind.onward && !kind.onward->empty()) text += (text.empty() ? "… " : " and … ") + *kind.onward;
    return text;
}

}  // namespace lightnet
