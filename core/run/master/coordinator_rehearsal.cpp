// The beginning and the end of a coordinator's rehearsals.
#include <algorithm>
#include <set>
#include <utility>

#include "core/run/master/coordinator.hpp"

namespace lightnet {
namespace {

constexpr std::uint32_t tiles_per_place = 4;  // of a rehearsal: small ones, or bundles of them
constexpr double least_patience = 0.5;        // seconds

}  // namespace

// Copies that wait for a rehearsal, all for the same one: results of calls before it are there.
std::set<NodeCopy> Coordinator::waiting_to_rehearse() {
    std::set<NodeCopy> waiting;
    for (const auto& copy : copies(done_)) {
        const auto& follower = followers_[copy];
        if (follower.state == Follower::State::waiting && follower.at.kind == StepReport::Kind::rehearse &&
            !calls_.reported(copy.node, follower.at).done())
            waiting.insert(copy);
    }
    return waiting;
}

// Those who take part are known when it begins, so it waits a little for those who would come in its middle, and as
// long as it takes for those who may be asked already.
bool Coordinator::is_time_to_rehearse(const std::set<NodeCopy>& waiting) {
    const double now = steady_seconds();
    if (waiting.empty()) first_waits_.reset();
    if (waiting.empty() || waiting.size() == copies(done_).size()) return !waiting.empty();
    const auto nodes = nodes_at(done_);
    const bool all_nodes = std::all_of(nodes.begin(), nodes.end(), [&](std::size_t node) {
        return std::any_of(waiting.begin(), waiting.end(), [&](const auto& copy) { return copy.node == node; });
    });
    if (!first_waits_) first_waits_ = now;
    const auto asked = copies_in_force(done_);
    return all_nodes && std::includes(waiting.begin(), waiting.end(), asked.begin(), asked.end()) &&
           now - *first_waits_ > std::max(least_patience, (*first_waits_ - went_on_) / 2);
}

// Begins a rehearsal when the copies of the node wait for it, and gathers what they have noted when it is over.
void Coordinator::collect() {
    if (done_ == order_.size()) return;
    if (!rehearsal_) {
        const auto waiting = waiting_to_rehearse();
        if (is_time_to_rehearse(waiting)) begin_rehearsal(waiting);
        return;
    }
    for (const auto& copy : rehearsal_->copies())
        if (rehearsal_->wants_notes_of(copy) &&
            send({copy, done_, {.kind = Step::Kind::collect, .call = rehearsal_->call(), .first = epoch_.number()}}))
            rehearsal_->asked(copy);
}

void Coordinator::begin_rehearsal(const std::set<NodeCopy>& taking_part) {
    const auto call = followers_[*taking_part.begin()].at.call;
    first_waits_.reset();
    MasterRenderer::Job job;
    job.run = options_.run;
    job.image = static_cast<std::uint32_t>(renderer_of(*options_.graph, *options_.registry));
    job.width = options_.width;
    job.tiles = rehearsal_tiles(*options_.graph, *options_.registry, calls_.of(order_[done_], call).what().count,
                                pass_of_call(call));
    job.credit = {tiles_per_place, tiles_per_place * MasterRenderer::most_together};
    job.double_tail = false;  // what is still under way at its end would note questions in the next rehearsal
    epoch_.begin_next();
    rehearsal_ = std::make_unique<ConductedRehearsal>(call, taking_part, std::move(job), *this);
    enforce();  // who could not be asked because of the rehearsal before can be now
    rehearsal_->use(plans_.in_force);
}

void Coordinator::noted(const Sent& sent, const Bytes& data) {
    // What was noted in one that was broken off, perhaps of the same call, does not count.
    if (!rehearsal_ || rehearsal_->broken() || sent.step.first != epoch_.number()) return;
    if (!rehearsal_->collect(data)) return;
    const auto result = rehearsal_->result();
    end_rehearsal();
    calls_.of(order_[sent.position], sent.step.call).complete(result);
    calls_.keep(order_[sent.position], sent.step.call);
    went_on_ = steady_seconds();
    advance();
}

void Coordinator::end_rehearsal() {
    rehearsal_.reset();
    epoch_.begin_next();
}

}  // namespace lightnet
