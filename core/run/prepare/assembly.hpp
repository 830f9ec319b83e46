// Makes the nodes of a network out of its graph.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "core/network/graph/graph.hpp"
#include "core/network/graph/kind.hpp"
#include "core/network/graph/layout.hpp"
#include "core/network/graph/plan.hpp"
#include "core/network/light/inputs.hpp"
#include "core/network/light/light_op.hpp"
#include "core/network/light/locks.hpp"
#include "core/network/light/node_context.hpp"
#include "core/network/light/rehearsal.hpp"
#include "core/network/light/renderer.hpp"
#include "core/network/light/sectors.hpp"
#include "core/run/prepare/direct_port.hpp"
#include "core/run/prepare/kept.hpp"
#include "core/run/prepare/prepared.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {

/// A network that can be assembled: a checked graph and what its nodes are made from. Constant, shared by all places
/// of a process.
struct Network {
    Graph graph;
    const Registry& registry;
    std::shared_ptr<const Scene> scene;
    std::uint64_t seed = 0;
    Layers layers = layers_of(graph, registry);
    std::shared_ptr<SharedValues> shared = std::make_shared<SharedValues>();
    std::function<Bytes(const Hash&)> results = {};  // of preparing, that came by themselves; called from any place
    bool check_answers = false;                      // wrapped classes are asked twice, to find those with a memory
    KeptResults kept = {};                           // by earlier runs

    const Kind& kind_of(std::size_t node) const { return *registry.find(graph.nodes[node].kind); }
    /// Colours per answer when nothing is added up.
    std::size_t width_of(std::size_t node) const;
    /// How the scene is cut up for a sharded node, or for one of those that stand for its sectors. Made when it is
    /// first asked for, alike in all processes. Throws Error when the node's kind can't be sharded.
    std::shared_ptr<const Sectors> sectors(std::size_t node) const;
};

/// The nodes of one place, made when first needed.
class Assembly {
public:
    /// Gives the port through which nodes of this place ask `node` for `width` colours per question. The port must
    /// outlive the assembly.
    using PortTo = std::function<Port*(std::size_t node, std::size_t width)>;

    /// `locks` are those of the place. `side_by_side` serves the nodes that have many small things to wait for; none:
    /// one after the other.
    Assembly(const Network& network, PortTo port_to, Locks& locks, SideBySide* side_by_side = nullptr)
        : network_(network), port_to_(std::move(port_to)), locks_(locks), side_by_side_(side_by_side) {}

    const LightOp& light(std::size_t node);
    /// Has the node prepare itself.
    void prepare(std::size_t node, Services& services);
    Rehearsal& rehearsal(std::size_t node);
    Callee callee(std::size_t node) {
        return {light(node), network_.graph.nodes[node].name, network_.width_of(node),
                network_.kind_of(node).side_by_side, &not_finite_[node]};
    }
    /// Answers that were infinite or no numbers, by name of the node; nodes that gave none are left out.
    std::map<std::string, std::uint64_t> not_finite() const {
        std::map<std::string, std::uint64_t> counts;
        for (const auto& [node, count] : not_finite_)
            if (count) counts[network_.graph.nodes[whole_of(network_.graph, node)].name] += count;
        return counts;
    }
    const Renderer& renderer(std::size_t node);

private:
    Inputs inputs_of(std::size_t node);
    NodeContext::Own own_of(std::size_t node);

    const Network& network_;
    PortTo port_to_;
    Locks& locks_;
    SideBySide* side_by_side_;
    std::vector<std::unique_ptr<Port>> guarded_;
    std::map<std::size_t, Rehearsal> rehearsals_;
    std::map<std::size_t, std::uint64_t> not_finite_;
    std::map<std::size_t, std::unique_ptr<LightOp>> lights_;
    std::map<std::size_t, std::unique_ptr<Renderer>> renderers_;
};

}  // namespace lightnet
