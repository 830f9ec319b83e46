// The nodes that have left places.
#pragma once

#include <algorithm>
#include <iterator>

#include "core/run/master/prepare_state.hpp"
#include "core/run/master/shard_work.hpp"
#include "core/run/master/step_line.hpp"

namespace lightnet {

/// Lets go of nodes at places that the plan has taken them from, when nobody can ask for them there any more: some time
/// after all have heard of the plan.
class DepartedNodes {
public:
    /// `after`: seconds.
    DepartedNodes(PrepareState& state, StepLine& steps, ShardWork& shards, double after)
        : state_(state), steps_(steps), shards_(shards), after_(after) {}

    /// Call it now and then.
    void let_go() {
        const double now = steady_seconds();
        if (now - looked_ < std::min(1.0, after_)) return;
        looked_ = now;
        for (auto known = state_.followers.begin(); known != state_.followers.end();) {
            auto& [copy, follower] = *known++;
            if (follower.left == 0 || follower.state == Follower::State::asked) continue;
            const bool asked = holds(state_.in_force, copy.place, copy.node);
            if (asked) follower.left = now;
            if (asked || now - follower.left < after_) continue;
            if (!steps_.send({copy, 0, {.kind = Step::Kind::leave}})) continue;
            shards_.let_go(copy);
            state_.followers.erase(std::prev(known));
        }
    }

private:
    PrepareState& state_;
    StepLine& steps_;
    ShardWork& shards_;
    double after_;
    double looked_ = 0;  // when last
};

}  // namespace lightnet
