#include "core/run/prepare/assembly.hpp"

#include <algorithm>

#include "core/base/error.hpp"
#include "core/network/light/node_context.hpp"

namespace lightnet {
namespace {

using Terminals = std::vector<std::size_t>;

// Which position of `whole` each of `part` has.
std::vector<std::uint32_t> positions(const Terminals& part, const Terminals& whole, std::uint32_t first) {
    std::vector<std::uint32_t> at;
    for (const auto terminal : part) {
        const auto found = std::find(whole.begin(), whole.end(), terminal);
        at.push_back(first + static_cast<std::uint32_t>(found - whole.begin()));
    }
    return at;
}

// Sees to it that nobody asks with a lock in hand.
class GuardedPort final : public Port {
public:
    GuardedPort(Port& port, const Locks& locks) : port_(port), locks_(locks) {}
    Ticket begin(std::span<const Query> questions, std::span<Rgb> answers) override {
        locks_.check_may_ask();
        return port_.begin(questions, answers);
    }
    void finish(Ticket ticket) override { port_.finish(ticket); }
    void abandon(Ticket ticket) noexcept override { port_.abandon(ticket); }

private:
    Port& port_;
    const Locks& locks_;
};

template <class Make>
auto made(const Network& network, std::size_t node, Inputs inputs, NodeContext::Own own, const Make& make) {
    const auto& what = network.graph.nodes[whole_of(network.graph, node)];  // nobody knows that it has a sector
    try {
        return make(NodeContext(what, std::move(inputs), *network.scene, network.seed, own));
    } catch (const std::exception& error) {
        throw Error(what.kind + " '" + what.name + "'", error.what());
    }
}

}  // namespace

std::size_t Network::width_of(std::size_t node) const {
    return kind_of(node).role == Role::image ? colours_of(layers) : layers.of_node[node].size();
}

std::shared_ptr<const Sectors> Network::sectors(std::size_t node) const {
    const std::size_t whole = whole_of(graph, node);
    const auto& what = graph.nodes[whole];
    if (!kind_of(whole).landmarks) throw Error(what.kind + " '" + what.name + "'", "can't be sharded");
    // As nobody prepares the sharded node itself, none of the shared values is its own.
    return std::static_pointer_cast<const Sectors>(shared->get(whole, 0, [&]() -> SharedValues::Value {
        const auto count = static_cast<std::uint32_t>(sectors_of(graph, whole).size());
        return std::make_shared<const Sectors>(kind_of(whole).landmarks(NodeContext(what, {}, *scene, seed)), count);
    }));
}

Inputs Assembly::inputs_of(std::size_t node) {
    const auto& of_node = network_.layers.of_node;
    const bool image = network_.kind_of(node).role == Role::image;
    const bool additive = image ? !network_.kind_of(node).merges : of_node[node] != Terminals{node};
    std::vector<Input> inputs;
    for (const auto asked : network_.graph.inputs_of(node)) {
        Input input;
        input.name = network_.graph.nodes[asked].name;
        if (additive) input.layers = positions(of_node[asked], of_node[node], image ? 1 : 0);  // 0 is emission
        input.port = port_to_(asked, input.width());
        if (network_.kind_of(node).locks)
            input.port = guarded_.emplace_back(std::make_unique<GuardedPort>(*input.port, locks_)).get();
        inputs.push_back(std::move(input));
    }
    if (image)
        for (std::size_t i = 0; i < network_.layers.shown.size(); ++i) {
            const auto shown = network_.layers.shown[i];
            const auto layer = static_cast<std::uint32_t>(network_.layers.film.size() + i);
            inputs.push_back({network_.graph.nodes[shown].name, port_to_(shown, 1), {layer}});
        }
    return {std::move(inputs), network_.width_of(node)};
}

NodeContext::Own Assembly::own_of(std::size_t node) {
    const auto taken = [this](const std::string& name) -> const LightOp& {
        return light(network_.graph.find(name).value());
    };
    const auto kept = network_.kept.find(network_.graph.nodes[whole_of(network_.graph, node)].name);
    return {&rehearsals_[node],     &locks_, side_by_side_,
            network_.check_answers, taken,   kept == network_.kept.end() ? nullptr : kept->second};
}

const LightOp& Assembly::light(std::size_t node) {
    auto& light = lights_[node];
    if (!light) light = made(network_, node, inputs_of(node), own_of(node), network_.kind_of(node).make_light);
    return *light;
}

void Assembly::prepare(std::size_t node, Services& services) {
    const auto& what = network_.graph.nodes[node];
    light(node);
    try {
        lights_[node]->prepare(services);
    } catch (const std::exception& error) {
        throw Error(what.kind + " '" + what.name + "', preparing", error.what());
    }
}

Rehearsal& Assembly::rehearsal(std::size_t node) {
    if (!network_.kind_of(node).rehearses)
        throw Error("it asks for a rehearsal, but its kind does not say that it does");
    return rehearsals_[node];
}

const Renderer& Assembly::renderer(std::size_t node) {
    auto& renderer = renderers_[node];
    if (!renderer) renderer = made(network_, node, inputs_of(node), own_of(node), network_.kind_of(node).make_renderer);
    return *renderer;
}

}  // namespace lightnet
