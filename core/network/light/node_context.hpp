// The world, as far as a node may know it when it is made.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/base/bytes.hpp"
#include "core/base/math/random.hpp"
#include "core/network/graph/graph.hpp"
#include "core/network/light/concurrent.hpp"
#include "core/network/light/inputs.hpp"
#include "core/network/light/scratch.hpp"
#include "core/network/light/whereabouts.hpp"

namespace lightnet {

class LightOp;
class Locks;
class Rehearsal;
class Scene;

/// What a place gives each node beside its inputs. Null: a rehearsal that is never on, locks that are always free, one
/// piece of work after the other, scratch space of its own, one place.
struct NodeServices {
    Rehearsal* rehearsal = nullptr;
    Locks* locks = nullptr;
    Concurrent* concurrent = nullptr;
    Scratch* scratch = nullptr;
    std::function<Whereabouts()> whereabouts = {};
    std::uint64_t* off_surface = nullptr;  // counts points asked about that no surface is near
    bool checking = false;                 // is this a run that looks for wrapped classes with a memory?
    std::function<const LightOp&(const std::string& node)> taken = {};  // a node of the same place
    Bytes kept = nullptr;                                               // by an earlier run
    bool has_passes = false;  // does a node of the graph learn anew for each pass?
    std::uint32_t pass = 0;   // that the node is made for, if it is one of those
};

/// Handed to a node's constructor. Parameters have passed the schema of the node's kind and defaults are filled in,
/// so reading one that the schema doesn't name is a bug of the node. A node may keep a copy of it.
class NodeContext {
public:
    NodeContext(const Node& node, Inputs inputs, const Scene& scene, std::uint64_t seed, NodeServices services = {});

    const std::string& name() const { return node_.name; }
    /// The node's own key: derive streams as child(query.stream, here.key(), i).
    Key key() const { return key_of(node_.name); }
    const Scene& scene() const { return scene_; }
    const Inputs& inputs() const { return inputs_; }
    std::uint64_t seed() const { return seed_; }
    /// Where light() notes what it has nothing prepared for. Lives as long as the node.
    Rehearsal& rehearsal() const { return *services_.rehearsal; }
    /// For nodes whose kind says that it locks. Lives as long as the node.
    Locks& locks() const { return *services_.locks; }
    /// Something of this type that the nodes of a place share: one may find there what another has just worked out. It
    /// saves work, and no answer depends on it.
    template <class T>
    std::shared_ptr<T> shared() const {
        return services_.scratch ? services_.scratch->of<T>() : std::make_shared<T>();
    }
    /// For names of locks, and for display by nodes that are examples of it. Memory: see memory_for().
    Whereabouts whereabouts() const { return services_.whereabouts ? services_.whereabouts() : Whereabouts{}; }
    /// The node asks about a point that no surface is near: the run says how often it did.
    void count_off_surface() const {
        if (services_.off_surface) ++*services_.off_surface;
    }

    /// Was a parameter given that may be absent?
    bool has(const std::string& param) const { return node_.params.contains(param); }
    /// The node that a parameter of type node names, at the same place. It has prepared when this one prepares:
    /// frozen() gives what it has learnt.
    const LightOp& taken(const std::string& param) const;

    /// What an earlier run has kept of this scene for the node to go on from; null: nothing.
    const Bytes& kept() const { return services_.kept; }

    bool checking() const { return services_.checking; }

    /// The pass that the node is made for: a block of samples_per_block samples of the picture. Nodes whose kind says
    /// RunTraits::passes, and those that prepare and depend on one, are made and prepared anew for each.
    std::uint32_t pass() const { return services_.pass; }
    /// For Query::pass, of a question that a renderer asks for this sample of a pixel. Other nodes hand on the pass of
    /// the question that they answer.
    std::uint16_t pass_mark(std::uint32_t sample) const;

    /// Calls `work` for each of `count` pieces, one after the other or concurrently: see Concurrent. From light() only.
    void each(std::size_t count, std::size_t at_once, const Concurrent::Work& work) const;

    double number(const std::string& param) const;
    std::int64_t integer(const std::string& param) const;
    bool flag(const std::string& param) const;
    const std::string& text(const std::string& param) const;
    std::vector<double> numbers(const std::string& param) const;
    const Value& value(const std::string& param) const;

private:
    const Node& node_;
    Inputs inputs_;
    const Scene& scene_;
    std::uint64_t seed_;
    NodeServices services_;
};

/// Bytes that the node's process may use; 0: not known. A budget: it may end a run, and no answer may follow from it.
inline std::uint64_t memory_for(const NodeContext& here) { return here.whereabouts().memory; }

}  // namespace lightnet
