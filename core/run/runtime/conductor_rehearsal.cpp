// When a conductor begins a rehearsal, and when it ends.
#include <set>
#include <utility>

#include "core/run/runtime/conductor.hpp"

namespace lightnet {
namespace {

constexpr std::uint32_t tiles_per_place = 4;  // of a rehearsal: small ones, or bundles of them

}  // namespace

// Begins a rehearsal when all copies of the node wait for it, and gathers what they have noted when it is over.
void Conductor::collect() {
    if (done_ == order_.size()) return;
    if (!rehearsal_) {
        const auto all = copies(done_);
        if (all.empty()) return;
        const auto call = followers_[all[0]].at.call;
        for (const auto& copy : all) {
            const auto& follower = followers_[copy];
            if (follower.state != Follower::State::waiting || follower.at.kind != StepReport::Kind::rehearse ||
                follower.at.call != call || calls_.reported(copy.node, follower.at).done())
                return;
        }
        return begin_rehearsal(call);
    }
    for (const auto& copy : rehearsal_->copies())
        if (rehearsal_->wants_notes_of(copy) &&
            send({copy, done_, {.kind = Step::Kind::collect, .call = rehearsal_->call(), .first = epoch_.number()}}))
            rehearsal_->asked(copy);
}

void Conductor::begin_rehearsal(std::uint32_t call) {
    MasterRenderer::Job job;
    job.run = options_.run;
    job.image = static_cast<std::uint32_t>(renderer_of(*options_.graph, *options_.registry));
    job.width = options_.width;
    job.tiles = rehearsal_tiles(*options_.graph, *options_.registry, calls_.of(order_[done_], call).what().count,
                                pass_of_call(call));
    job.credit = {tiles_per_place, tiles_per_place * MasterRenderer::most_together};
    job.double_tail = false;  // what is still under way at its end would note questions in the next rehearsal
    epoch_.begin_next();
    const auto all = copies(done_);
    rehearsal_ =
        std::make_unique<ConductedRehearsal>(call, std::set<NodeCopy>(all.begin(), all.end()), std::move(job), *this);
    enforce();  // who could not be asked because of the rehearsal before can be now
    rehearsal_->use(in_force_);
}

void Conductor::noted(const Sent& sent, const Bytes& data) {
    // What was noted in one that was broken off, perhaps of the same call, does not count.
    if (!rehearsal_ || rehearsal_->broken() || sent.step.first != epoch_.number()) return;
    if (!rehearsal_->collect(data)) return;
    const auto result = rehearsal_->result();
    end_rehearsal();
    calls_.of(order_[sent.position], sent.step.call).complete(result);
    calls_.keep(order_[sent.position], sent.step.call);
    advance();
}

void Conductor::end_rehearsal() {
    rehearsal_.reset();
    epoch_.begin_next();
}

}  // namespace lightnet
