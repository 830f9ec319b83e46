// The state of preparing: which copies are how far, and what can be asked of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "core/run/master/prepare_order.hpp"
#include "core/run/message/step.hpp"
#include "core/run/schedule/multiplexer.hpp"

namespace lightnet {

/// A copy's prepare().
struct Follower {
    enum class State { idle, asked, waiting, done };
    State state = State::idle;
    StepReport at;
    double left = 0;  // when the node left its place; 0: it is to be there
};

/// What is known of all copies, and what all who lead them look at. The launcher's thread's.
///
/// What is proposed and what is in force: the carrier proposes a plan whenever hosts come or go. In force is the part
/// of it that can be asked: a place that is still behind is left out, and so is a node that was moved to a place and
/// is not prepared there yet.
struct PrepareState {
    PrepareState(const Graph& of, const Registry& registry);

    std::vector<NodeCopy> copies(std::size_t position) const { return order.copies(proposed, position); }
    /// Those that are in force: in a rehearsal, or prepared for the pass before. Somebody may ask them who has not
    /// heard yet that it is over.
    std::set<NodeCopy> copies_in_force(std::size_t position) const;
    bool is_done(const NodeCopy& copy) const;
    /// Is everything prepared that this place has to have before it prepares the node?
    bool may_begin(const NodeCopy& copy, std::size_t position) const;
    /// Can somebody answer for all that is prepared there?
    bool can_be_asked(std::size_t position) const;
    /// Are all copies past the calls before this one?
    bool all_past(std::size_t position, std::uint32_t call) const;
    bool all_done() const { return done == order.size(); }
    /// Up to where: what is prepared, for those who come late, and the whole stage of what is not.
    std::size_t led() const { return order.end_of_stage(done); }
    /// Takes a plan; notes which nodes have left their places.
    void propose(const Plan& plan);
    /// Something is there that nodes have to have in order to go on.
    void goes_on() { went_on = steady_seconds(); }

    const Graph& graph;
    PrepareOrder order;
    Plan proposed, in_force;
    std::map<NodeCopy, Follower> followers;
    std::size_t done = 0;  // positions that can be asked
    double went_on = steady_seconds();
};

/// The places that hold a node.
std::set<PlaceAt> places_of(const Plan& plan, std::size_t node);

}  // namespace lightnet
