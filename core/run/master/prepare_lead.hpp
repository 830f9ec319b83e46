// The lead of all places of a run through preparing.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "core/run/assembly/prepare_progress.hpp"
#include "core/run/master/departed_nodes.hpp"
#include "core/run/master/lock_client.hpp"
#include "core/run/master/plan_in_force.hpp"
#include "core/run/master/rehearsals.hpp"
#include "core/run/master/said_once.hpp"
#include "core/run/master/shard_work.hpp"

namespace lightnet {

/// What a run is prepared for, and how.
struct PrepareOptions {
    std::uint64_t run = 0;
    const Graph* graph = nullptr;  // outlives the coordinator, like the registry
    const Registry* registry = nullptr;
    std::uint32_t width = 1;       // colours per pixel
    MadeFrom made_from;            // see Recipes
    ResultCache* cache = nullptr;  // may be absent
    std::uint32_t verify = 0;      // millionths of the shards that two hosts are asked
    double let_go_after = 5;       // seconds, since a node has left a place: who has not heard yet may ask for it
    std::function<void(const std::string&)> say = [](const std::string&) {};
};

/// Nodes prepare stage by stage, inputs first, see PrepareOrder, each on all places that hold it: shards go to whoever
/// is free, results are put together here, in order, and brought to all. A stage ends when somebody can answer for each
/// of its nodes: slower places join later. The sectors of a sharded node prepare together, each in its own copies,
/// which get their parts of the results alone. A place that comes later is given the results, and is made known to the
/// others when it has caught up. The launcher's thread's.
class PrepareLead {
public:
    /// `carrier`: of all steps; `masters`: of rehearsals, whose replies `epoch` tells apart, and of plans in force.
    PrepareLead(PrepareOptions options, Carrier& carrier, Carrier& masters, Epoch& epoch);

    void propose(const Plan& plan);
    void begin_pass(std::uint32_t pass);
    /// Leads on as far as it goes without waiting. Throws Error when a node failed.
    void advance();
    /// Renders a rehearsal for about `most`. False: none is to be rendered.
    bool render(std::chrono::nanoseconds most) { return rehearsals_.render(most); }
    /// A reply on a channel of Epoch::own().
    void take(Message message);
    /// Does what is due though nothing has come. Call it now and then.
    void tick();
    PrepareProgress progress() const;
    const PrepareState& state() const { return state_; }
    const ServiceCalls& calls() const { return calls_; }

private:
    void lead(const NodeCopy& copy, std::size_t position);
    void enforce();
    void reported(const SentStep& sent, const Bytes& data);

    Carrier& masters_;
    PrepareState state_;
    ServiceCalls calls_;
    StepLine steps_;
    ShardWork shards_;
    PlanInForce plan_{state_};
    Rehearsals rehearsals_;
    std::optional<LockClient> locks_;  // none: nobody in the graph locks
    std::uint32_t pass_ = 0;
    DepartedNodes departed_;
    SaidOnce said_;
};

}  // namespace lightnet
