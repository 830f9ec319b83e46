// Leads all places of a run through preparing, and lets nobody ask a place that is not prepared.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "core/run/master/prepare_lead.hpp"
#include "core/run/message/forwarding_carrier.hpp"

namespace lightnet {

/// Stands between the run's carrier and the masters that follow each other on it, of rehearsals and of the picture:
/// they are told of plans in force, and get replies to their own asks. Preparing goes on meanwhile, see PrepareLead.
/// Belongs to the launcher's thread.
class Coordinator final : public ForwardingCarrier {
public:
    using Options = PrepareOptions;
    Coordinator(Options options, Carrier& carrier)
        : ForwardingCarrier(carrier), run_(options.run), lead_(std::move(options), carrier, *this, epoch_) {}

    /// What the carrier offers from now on.
    void propose(const Plan& plan) { lead_.propose(plan); }
    /// Leads on for about `most`. True when every node is prepared on some place: those that are behind are asked when
    /// they have caught up. Throws Error when a node failed.
    bool prepare(std::chrono::nanoseconds most);
    /// What is prepared from now on is for this pass of the picture: nodes that learn anew for each do so, and those
    /// that are prepared already stay. Work of the pass before must be done, and its master gone.
    void begin_pass(std::uint32_t pass) { lead_.begin_pass(pass); }
    /// Another master is to follow the one before, when all is prepared: late replies to that are none to this.
    void begin_master() { epoch_.begin_next(); }
    /// What can be asked now, and what will be.
    const Plan& in_force() const { return lead_.state().in_force; }
    const Plan& proposed() const { return lead_.state().proposed; }
    /// How far preparing is. Of nodes that prepare at the same time, the first one.
    PrepareProgress progress() const { return lead_.progress(); }
    /// What was prepared: node → content hash of all its results.
    std::map<std::string, Hash> prepared() const { return lead_.calls().hashes(); }
    /// The result of a node's last call, when it is prepared; null: it made none.
    Bytes last_result(std::size_t node) const { return lead_.calls().last_result(node); }

    bool ask(const PlaceAt& to, Message& message) override;
    /// Work for the master; plans in force. Preparing goes on inside.
    std::optional<Message> receive() override;
    void wait(std::chrono::nanoseconds most) override;
    void give_up(std::uint32_t channel) override;
    void adopt(const Plan& plan) override;

private:
    std::uint64_t run_;
    Epoch epoch_;  // of the master whose replies count
    PrepareLead lead_;
    std::deque<Message> plans_;  // in force, that the master is to be told
};

}  // namespace lightnet
