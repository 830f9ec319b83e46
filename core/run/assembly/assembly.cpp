#include "core/run/assembly/assembly.hpp"

#include <algorithm>
#include <optional>

#include "core/base/error.hpp"
#include "core/base/words_of.hpp"
#include "core/network/graph/lamp_groups.hpp"
#include "core/network/light/node_context.hpp"
#include "core/run/assembly/node_that_leaves.hpp"

namespace lightnet {
namespace {

using Terminals = std::vector<Terminal>;

// Which position of `whole` each of `part` has.
std::vector<std::uint32_t> positions(const Terminals& part, const Terminals& whole, std::uint32_t first) {
    std::vector<std::uint32_t> at;
    for (const auto& terminal : part) {
        const auto found = std::find(whole.begin(), whole.end(), terminal);
        at.push_back(first + static_cast<std::uint32_t>(found - whole.begin()));
    }
    return at;
}

/// See left_out_kind.
class LeftOut final : public LightOp {
public:
    void light(std::span<const Query>, std::span<Rgb>) const override {}
};

template <class Make>
auto made(const Network& network, std::size_t node, Inputs inputs, const NodeServices& services, const Make& make) {
    const auto& what = network.graph.nodes[whole_of(network.graph, node)];  // nobody knows that it has a sector
    try {
        return make(NodeContext(what, std::move(inputs), *network.scenes[whole_of(network.graph, node)], network.seed,
                                services));
    } catch (const std::exception& error) {
        throw Error(what.kind + " '" + what.name + "'", words_of(error));
    }
}

}  // namespace

std::vector<std::shared_ptr<const Scene>> scenes_of(const Graph& graph, const Registry& registry,
                                                    const std::shared_ptr<const Scene>& scene) {
    const auto groups = lamp_groups(graph, registry);
    std::map<SceneView, std::shared_ptr<const Scene>> made{{SceneView{}, scene}};
    const auto made_as = [&](const Scene& whole, const SceneView& view) {
        auto& seen = made[view];
        if (!seen) seen = std::make_shared<const Scene>(whole, view);
        return seen;
    };
    std::vector<std::shared_ptr<const Scene>> scenes;
    for (const auto& node : graph.nodes) {
        SceneView view{groups_wanted(node, groups), !groups.empty() && asks_for_groups(node)};
        const auto lit = made_as(*scene, view);  // shared by all who look for these lamps
        view.parts = reads_of(*registry.find(node.kind), node);
        scenes.push_back(made_as(*lit, view));
    }
    return scenes;
}

bool Network::answers_with(std::size_t node, std::size_t width) const {
    return width == 1 || width == width_of(node) || (layers.by_group[node] && width == layers.groups);
}

std::size_t Network::width_of(std::size_t node) const {
    return kind_of(node).role == Role::image ? colours_of(layers) : layers.of_node[node].size();
}

std::shared_ptr<const Sectors> Network::sectors(std::size_t node) const {
    const std::size_t whole = whole_of(graph, node);
    const auto& what = graph.nodes[whole];
    if (!kind_of(whole).run.landmarks) throw Error(what.kind + " '" + what.name + "'", "can't be sharded");
    // As nobody prepares the sharded node itself, none of the shared values is its own.
    return std::static_pointer_cast<const Sectors>(shared->get(whole, 0, {}, [&](Builders&) -> SharedValues::Value {
        const auto count = static_cast<std::uint32_t>(sectors_of(graph, whole).size());
        return std::make_shared<const Sectors>(
            kind_of(whole).run.landmarks(NodeContext(what, {}, *scenes[whole], seed)), count);
    }));
}

Port* Assembly::port_between(std::size_t asker, std::size_t asked, std::size_t width) {
    Edge::Watch watch = watch_;
    if (network_.kind_of(asker).run.locks) watch.locks = services_.locks;
    return edges_.emplace_back(std::make_unique<Edge>(Edge::Ends{asker, asked, width}, *port_to_(asked, width), watch))
        .get();
}

Inputs Assembly::inputs_of(std::size_t node) {
    const auto& of_node = network_.layers.of_node;
    const bool image = network_.kind_of(node).role == Role::image;
    // what it asks it keeps apart as it comes, or by groups of lamps alone, or not at all
    const bool additive =
        image ? !network_.kind_of(node).light.merges : of_node[node].empty() || of_node[node].front().node != node;
    const auto emission = static_cast<std::uint32_t>(network_.layers.emission);
    std::vector<Input> inputs;
    for (const auto asked : network_.graph.inputs_of(node)) {
        Input input;
        input.name = network_.graph.nodes[asked].name;
        if (additive)
            input.layers = positions(of_node[asked], of_node[node], image ? emission : 0);
        else if (network_.layers.by_group[node])
            input.layers = positions(of_node[node], of_node[node], 0);
        if (image)
            for (auto& layer : input.layers) layer = network_.layers.of_colour[layer];
        if (network_.graph.nodes[asked].kind != left_out_kind) input.port = port_between(node, asked, input.width());
        inputs.push_back(std::move(input));
    }
    if (image)
        for (std::size_t i = 0; i < network_.layers.shown.size(); ++i) {
            const auto shown = network_.layers.shown[i];
            const auto layer = static_cast<std::uint32_t>(first_colour(network_.layers, i));
            inputs.push_back({network_.graph.nodes[shown].name,
                              port_between(node, shown, 1),
                              {layer},
                              network_.kind_of(shown).light.facts,
                              network_.layers.ids[i]});
        }
    return {std::move(inputs), network_.width_of(node), image ? network_.layers.halved : std::vector<std::uint32_t>{}};
}

NodeServices Assembly::services_of(std::size_t node) {
    NodeServices services = services_;
    services.rehearsal = &rehearsals_[node];
    services.off_surface = &bad_.off_surface[node];
    const auto kept = network_.kept.find(network_.graph.nodes[whole_of(network_.graph, node)].name);
    if (kept != network_.kept.end()) services.kept = kept->second;
    return services;
}

std::map<std::string, std::uint64_t> by_name(const Network& network,
                                             const std::map<std::size_t, std::uint64_t>& by_node) {
    std::map<std::string, std::uint64_t> counts;
    for (const auto& [node, count] : by_node)
        if (count) counts[network.graph.nodes[whole_of(network.graph, node)].name] += count;
    return counts;
}

std::unique_ptr<LightOp> Assembly::make_light(std::size_t node, const Inputs& inputs, std::uint32_t pass) {
    if (network_.graph.nodes[node].kind == left_out_kind) return std::make_unique<LeftOut>();
    NodeServices services = services_of(node);
    services.pass = pass;
    return made(network_, node, inputs, services, network_.kind_of(node).make_light);
}

const LightOp& Assembly::light(std::size_t node) {
    auto& light = lights_[node];
    if (light) return *light;
    Inputs inputs = inputs_of(node);
    if (network_.renewed[node])
        light = std::make_unique<NodeByPass>(
            [this, node, inputs](std::uint32_t pass) { return make_light(node, inputs, pass); });
    else if (network_.kind_of(node).run.prepares)
        light = std::make_unique<NodeThatLeaves>([this, node, inputs] { return make_light(node, inputs, 0); });
    else
        light = make_light(node, inputs, 0);
    return *light;
}

void Assembly::leave(std::size_t node) {
    const auto known = lights_.find(node);
    if (known == lights_.end() || !network_.kind_of(node).run.prepares) return;
    if (network_.renewed[node])
        static_cast<NodeByPass&>(*known->second).leave();
    else
        static_cast<NodeThatLeaves&>(*known->second).leave();
    rehearsals_[node] = {};  // by which others know it still
    network_.shared->forget(node);
}

void Assembly::prepare(std::size_t node, Services& services, std::uint32_t pass) {
    const auto& what = network_.graph.nodes[node];
    light(node);
    std::optional<ScopedActivity> turned;
    if (gauge_) turned.emplace(*gauge_, Gauge::at(node));
    try {
        if (network_.renewed[node]) static_cast<NodeByPass&>(*lights_[node]).begin(pass);
        lights_[node]->prepare(services);
    } catch (const std::exception& error) {
        throw Error(what.kind + " '" + what.name + "', preparing", words_of(error));
    }
}

Rehearsal& Assembly::rehearsal(std::size_t node) {
    if (!network_.kind_of(node).run.rehearses)
        throw Error("it asks for a rehearsal, but its kind does not say that it does");
    return rehearsals_[node];
}

const Renderer& Assembly::renderer(std::size_t node) {
    auto& renderer = renderers_[node];
    if (!renderer)
        renderer = made(network_, node, inputs_of(node), services_of(node), network_.kind_of(node).make_renderer);
    return *renderer;
}

}  // namespace lightnet
