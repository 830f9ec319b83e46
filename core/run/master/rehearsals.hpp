// The rehearsals of preparing nodes, one at a time.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>

#include "core/network/graph/kind.hpp"
#include "core/run/assembly/prepare_progress.hpp"
#include "core/run/master/conducted_rehearsal.hpp"
#include "core/run/master/prepare_state.hpp"
#include "core/run/master/service_calls.hpp"
#include "core/run/master/step_line.hpp"

namespace lightnet {

/// Begins a rehearsal when the copies of a node wait for it, has its tiles rendered, and gathers what they have noted
/// when it is over. It is broken off, and begins again, when one of those that take part is lost. The launcher's
/// thread's.
class Rehearsals {
public:
    /// Whose they are. All outlive them.
    struct Lent {
        std::uint64_t run;
        std::uint32_t width;  // colours per pixel
        const Registry& registry;
        PrepareState& state;
        ServiceCalls& calls;
        StepLine& steps;
        Carrier& carrier;  // of the master, whose replies are told apart by `epoch`
        Epoch& epoch;
    };
    explicit Rehearsals(const Lent& lent) : at_(lent) {}

    /// Those who take part; null: none goes on.
    const std::set<NodeCopy>* copies() const { return now_ ? &now_->copies() : nullptr; }
    /// Asks for the notes of one that is rendered, or begins one when it is time. True: it has begun, and renders when
    /// it has been told where, see use().
    bool advance();
    void use(const Plan& plan) { now_->use(plan); }
    /// Renders on for about `most`. False: there is nothing to render.
    bool render(std::chrono::nanoseconds most);
    /// One who takes part may be lost.
    void break_off();
    /// Takes part only who holds the node: else it is broken off.
    void keep();
    /// A copy has said what it noted. True: that was the last, and the call has its result.
    bool noted(const SentStep& sent, const Bytes& data);
    void end();
    /// Fills in how far it is.
    void tell(PrepareProgress& progress) const;

private:
    std::set<NodeCopy> waiting();
    bool is_time(const std::set<NodeCopy>& waiting);
    void begin(const std::set<NodeCopy>& taking_part);

    Lent at_;
    std::unique_ptr<ConductedRehearsal> now_;
    std::optional<double> first_waits_;  // since when somebody waits for the next one
};

}  // namespace lightnet
