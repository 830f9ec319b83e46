// What a node may know of the world when it is made.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/math/random.hpp"
#include "core/network/graph/graph.hpp"
#include "core/network/light/concurrent.hpp"
#include "core/network/light/inputs.hpp"

namespace lightnet {

class LightOp;
class Locks;
class Rehearsal;
class Scene;

/// What a place gives each node beside its inputs. Null: a rehearsal that is never on, locks that are always free, one
/// piece of work after the other.
struct NodeServices {
    Rehearsal* rehearsal = nullptr;
    Locks* locks = nullptr;
    Concurrent* concurrent = nullptr;
    bool checking = false;  // is this a run that looks for wrapped classes with a memory?
    std::function<const LightOp&(const std::string& node)> taken = {};  // a node of the same place
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

    /// The node that a parameter of type node names, at the same place. It has prepared when this one prepares:
    /// frozen() gives what it has learnt.
    const LightOp& taken(const std::string& param) const;

    bool checking() const { return services_.checking; }

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

}  // namespace lightnet
