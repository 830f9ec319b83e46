#include "core/network/graph/path_layers.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/base/in_quotes.hpp"
#include "core/base/lamp_groups.hpp"
#include "core/network/graph/check_params.hpp"
#include "core/network/graph/lamp_groups.hpp"
#include "core/network/graph/light_paths.hpp"
#include "core/network/graph/path_expression.hpp"

namespace lightnet {
namespace {

/// What one name of the parameter stands for.
struct NamedPaths {
    std::string name;
    std::vector<PathExpression> any;  // of these
    std::vector<PathSet> by_group;
    bool sorts = false;  // it names groups of lamps itself
    bool found = false;  // somebody has such light, or why not has been said
};

/// How much of a colour a layer wants, with an example of each.
struct Overlap {
    std::optional<std::string> has, lacks;
};

class Sorting {
public:
    Sorting(const Graph& graph, const Registry& registry, const std::vector<Terminal>& colours,
            const std::vector<bool>& by_group)
        : graph_(graph),
          renderer_(graph.nodes[renderer_of(graph, registry)]),
          groups_(lamp_groups(graph, registry)),
          colours_(colours),
          by_group_(by_group) {
        made_.names.resize(colours.size());
        read();
        if (named_.empty()) return;
        std::vector<std::size_t> nodes;
        for (const auto& colour : colours) nodes.push_back(colour.node);
        arriving_ = paths_at_image(graph, registry, nodes);
        try {
            for (std::size_t c = 0; c < colours.size(); ++c) sort(c);
        } catch (const Error& error) {
            complain(named_.front().name, std::string("these, or others beside them, are ") + error.what());
            return;
        }
        for (const auto& layer : named_)
            if (!layer.found) complain(layer.name, "no operator of the graph counts such light");
    }
    PathLayers take() { return std::move(made_); }

private:
    void complain(const std::string& layer, const std::string& what) {
        made_.problems.push_back({renderer_.where, renderer_.kind + " " + in_quotes(renderer_.name) +
                                                       ": 'layers': " + in_quotes(layer) + ": " + what});
    }

    void read() {
        const auto given = renderer_.params.find("layers");
        if (given == renderer_.params.end()) return;
        for (const auto& [name, value] : std::get<Table>(given->second.data).named) {
            if (const auto why = why_no_name(name); !why.empty()) {
                complain(name, why);
                continue;
            }
            NamedPaths layer{name, {}, {}, false, false};
            for (const auto& text : names_in(value)) {
                try {
                    layer.any.emplace_back(text);
                    look_for_groups(layer);
                } catch (const Error& error) {
                    complain(name, error.what());
                    layer.found = true;
                }
            }
            named_.push_back(std::move(layer));
        }
        for (auto& layer : named_) find_paths(layer);
    }

    // Where one layer is light that media scatter, others mean surfaces when they say D.
    Collisions collisions() const {
        for (const auto& layer : named_)
            for (const auto& expression : layer.any)
                if (expression.names_collisions()) return Collisions::apart;
        return Collisions::rough;
    }

    void find_paths(NamedPaths& layer) const {
        layer.by_group.resize(std::max<std::size_t>(1, groups_.size()));
        for (const auto& expression : layer.any)
            for (std::size_t g = 0; g < layer.by_group.size(); ++g)
                layer.by_group[g] =
                    layer.by_group[g].with(expression.of(groups_.empty() ? "" : groups_[g], collisions()));
    }

    std::string why_no_name(const std::string& name) const {
        if (!is_name(name)) return name_rule;
        if (name == "emission" || graph_.find(name)) return "is the name of a node or of its layer already";
        if (std::find(groups_.begin(), groups_.end(), name) != groups_.end()) return "is the name of a group already";
        return "";
    }

    void look_for_groups(NamedPaths& layer) {
        for (const auto& group : layer.any.back().groups()) {
            layer.sorts = true;
            if (std::find(groups_.begin(), groups_.end(), group) != groups_.end()) continue;
            complain(layer.name, "the scene has no group " + in_quotes(group) + suggest(group, groups_));
            layer.found = true;
        }
    }

    Overlap overlap(std::size_t colour, const NamedPaths& layer) {
        Overlap found;
        const auto& paths = arriving_[colour].by_group;
        for (std::size_t g = 0; g < paths.size(); ++g) {
            if (by_group_[colours_[colour].node] && g != colours_[colour].group) continue;
            if (!found.has) found.has = PathSet::common(paths[g], layer.by_group[g], &steps_left_);
            if (!found.lacks) found.lacks = PathSet::missing(paths[g], layer.by_group[g], &steps_left_);
        }
        return found;
    }

    void sort(std::size_t colour) {
        const auto& node = graph_.nodes[colours_[colour].node];
        const std::string who = &node == &renderer_ ? "'emission'" : in_quotes(node.name);
        const NamedPaths* taken_by = nullptr;
        for (auto& layer : named_) {
            const auto [has, lacks] = overlap(colour, layer);
            if (!arriving_[colour].known) {
                complain(layer.name, who + " does not say which paths it counts");
                layer.found = true;
            }
            if (!has) continue;
            layer.found = true;
            if (lacks) {
                complain(layer.name, "takes " + *has + " of " + who + ", but not " + *lacks + ": " +
                                         why_not_apart(*has, *lacks, layer));
            } else if (taken_by) {
                complain(layer.name, *has + " of " + who + " is in " + in_quotes(taken_by->name) +
                                         " already, and an image is the sum of its layers");
            } else {
                taken_by = &layer;
            }
        }
        if (taken_by) made_.names[colour] = name_for(colour, *taken_by);
        if (&node == &renderer_) check_emission(colour);
    }

    // The renderer adds its own light to its first layers, one for each group.
    void check_emission(std::size_t colour) {
        const auto& name = made_.names[colour];
        const auto end = made_.names.begin() + static_cast<std::ptrdiff_t>(colour);
        if (!name.empty() && std::find(made_.names.begin(), end, name) != end)
            complain(name, "takes the emission of several groups: name one, like L'" + groups_[colour] + "'");
    }

    // Words go from the light to the eye here, as everywhere in what check() says.
    static std::string why_not_apart(const std::string& has, const std::string& lacks, const NamedPaths& layer) {
        if (has == lacks && layer.sorts) return "it does not keep groups of lamps apart: write groups = true there";
        if (has == lacks) return "it does not keep lamps apart from the background. A group of lamps can hold that";
        if (shows_medium(has) != shows_medium(lacks))
            return "no operator keeps these apart. Select { …, where = \"media\" } keeps them apart";
        return "no operator keeps these apart. Write S* behind C where what mirrors and glass show is meant as well";
    }

    // Behind mirrors and glass, which are shown in the layer of what is seen there.
    static bool shows_medium(const std::string& path) {
        const auto seen = path.find_last_not_of("SE");
        return seen != path.npos && path[seen] == 'V';
    }

    std::string name_for(std::size_t colour, const NamedPaths& layer) {
        const auto& [node, group] = colours_[colour];
        return by_group_[node] && !layer.sorts ? layer.name + "." + groups_[group] : layer.name;
    }

    const Graph& graph_;
    const Node& renderer_;
    const std::vector<std::string> groups_;
    const std::vector<Terminal>& colours_;
    const std::vector<bool>& by_group_;
    std::vector<NamedPaths> named_;
    std::vector<ArrivingPaths> arriving_;  // by colour
    std::size_t steps_left_ = 20'000;  // a graph takes some hundreds; one that comes from a stranger, no more than this
    PathLayers made_;
};

}  // namespace

// DECISIONS: expressions-sort-operators
PathLayers path_layers(const Graph& graph, const Registry& registry, const std::vector<Terminal>& colours,
                       const std::vector<bool>& by_group) {
    return Sorting(graph, registry, colours, by_group).take();
}

}  // namespace lightnet
