// Makes the nodes of a network out of its graph.
#pragma once

#include <algorithm>
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
#include "core/run/assembly/activity.hpp"
#include "core/run/assembly/direct_port.hpp"
#include "core/run/assembly/edge.hpp"
#include "core/run/assembly/gauge.hpp"
#include "core/run/assembly/kept.hpp"
#include "core/run/assembly/node_by_pass.hpp"
#include "core/run/assembly/prepared.hpp"
#include "core/run/assembly/shared_values.hpp"
#include "core/scene/geometry/lost_rays.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {

/// Per node, the scene as it sees it: with the lamps that it looks for, their groups apart where it keeps them so, and
/// with the parts that its kind says it reads.
std::vector<std::shared_ptr<const Scene>> scenes_of(const Graph& graph, const Registry& registry,
                                                    const std::shared_ptr<const Scene>& scene);

/// A network that can be assembled: a checked graph and what its nodes are made from. Constant, shared by all places
/// of a process.
struct Network {
    Graph graph;
    const Registry& registry;
    std::shared_ptr<const Scene> scene;
    std::uint64_t seed = 0;
    Layers layers = layers_of(graph, registry);
    std::shared_ptr<SharedValues> shared = std::make_shared<SharedValues>();
    std::shared_ptr<Activity> activity = std::make_shared<Activity>();
    std::function<Bytes(const Hash&)> results = {};  // of preparing, that came by themselves; called from any place
    bool check_answers = false;                      // wrapped classes are asked twice, to find those with a memory
    KeptResults kept = {};                           // by earlier runs
    std::vector<bool> renewed = renewed_nodes(graph, registry);  // per node: it is made anew for each pass

    std::vector<std::shared_ptr<const Scene>> scenes = scenes_of(graph, registry, scene);

    bool has_passes() const { return std::find(renewed.begin(), renewed.end(), true) != renewed.end(); }
    const Kind& kind_of(std::size_t node) const { return *registry.find(graph.nodes[node].kind); }
    /// Colours per answer when nothing is added up.
    std::size_t width_of(std::size_t node) const;
    /// Can a node of light be asked for so many colours? All that it keeps apart, one for each group of lamps where it
    /// keeps these apart, or one.
    bool answers_with(std::size_t node, std::size_t width) const;
    /// How the scene is cut up for a sharded node, or for one of those that stand for its sectors. Made when it is
    /// first asked for, alike in all processes. Throws Error when the node's kind can't be sharded.
    std::shared_ptr<const Sectors> sectors(std::size_t node) const;
};

/// What has no place in a picture, by node: answers, points and questions.
struct BadLight {
    std::map<std::size_t, std::uint64_t> not_finite, off_surface, unsound;
};

/// Counts by node, by its name; nodes that have none are left out, and what has a sector goes by the whole.
std::map<std::string, std::uint64_t> by_name(const Network& network,
                                             const std::map<std::size_t, std::uint64_t>& by_node);

/// Of which node they are, the gauge knows, whatever fiber runs.
struct LostByNode final : LostRays {
    void lost() override {
        if (gauge && gauge->doing() >= Gauge::first_node) ++of_node[gauge->doing() - Gauge::first_node];
    }
    const Gauge* gauge = nullptr;
    std::map<std::size_t, std::uint64_t> of_node;
};

/// The nodes of one place, made when first needed.
class Assembly {
public:
    /// Gives the port through which nodes of this place ask `node` for `width` colours per question. The port must
    /// outlive the assembly.
    using PortTo = std::function<Port*(std::size_t node, std::size_t width)>;

    /// `services`: what the place gives all its nodes, locks among them. `watch`: what all their edges are watched by.
    Assembly(const Network& network, PortTo port_to, NodeServices services, const Edge::Watch& watch = {})
        : network_(network), port_to_(std::move(port_to)), watch_(watch), services_(std::move(services)) {
        services_.scratch = &scratch_;
        services_.checking = network.check_answers;
        services_.has_passes = network.has_passes();
        services_.taken = [this](const std::string& name) -> const LightOp& {
            return light(network_.graph.find(name).value());
        };
    }

    /// From now on, before the first node is made: says which of them is at work. The gauge outlives the assembly.
    void show(Gauge& gauge) { lost_rays_.gauge = gauge_ = &gauge; }

    const LightOp& light(std::size_t node);
    /// Has the node prepare itself; one that is renewed, for this pass.
    void prepare(std::size_t node, Services& services, std::uint32_t pass = 0);
    /// Others hold the node from now on: what it has learnt is let go of. It prepares again where it comes back.
    void leave(std::size_t node);
    Rehearsal& rehearsal(std::size_t node);
    Callee callee(std::size_t node) {
        return {light(node),
                network_.graph.nodes[node].name,
                network_.width_of(node),
                network_.kind_of(node).run.whole_calls,
                &bad_.not_finite[node],
                &bad_.unsound[node],
                gauge_,
                Gauge::at(node),
                network_.kind_of(node).light.space};
    }
    /// Answers that were infinite or no numbers, by name of the node; nodes that gave none are left out.
    std::map<std::string, std::uint64_t> not_finite() const { return by_name(network_, bad_.not_finite); }
    /// Questions about no surface, by name of the node that was asked; nodes that were asked none are left out.
    std::map<std::string, std::uint64_t> off_surface() const { return by_name(network_, bad_.off_surface); }
    /// Of questions whose numbers were not finite, by the node that was asked.
    std::map<std::string, std::uint64_t> unsound_questions() const { return by_name(network_, bad_.unsound); }
    /// Of rays that could not be traced, by the node that was at work.
    std::map<std::string, std::uint64_t> lost_rays() const { return by_name(network_, lost_rays_.of_node); }
    /// To be told of this thread's while its nodes are at work.
    LostRays& keeper_of_lost_rays() { return lost_rays_; }
    const Renderer& renderer(std::size_t node);

private:
    std::unique_ptr<LightOp> make_light(std::size_t node, const Inputs& inputs, std::uint32_t pass);
    Inputs inputs_of(std::size_t node);
    Port* port_between(std::size_t asker, std::size_t asked, std::size_t width);
    NodeServices services_of(std::size_t node);

    const Network& network_;
    PortTo port_to_;
    Edge::Watch watch_;
    NodeServices services_;
    Scratch scratch_;
    Gauge* gauge_ = nullptr;
    std::vector<std::unique_ptr<Edge>> edges_;
    std::map<std::size_t, Rehearsal> rehearsals_;
    BadLight bad_;
    LostByNode lost_rays_;
    std::map<std::size_t, std::unique_ptr<LightOp>> lights_;
    std::map<std::size_t, std::unique_ptr<Renderer>> renderers_;
};

}  // namespace lightnet
