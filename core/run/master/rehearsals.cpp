#include "core/run/master/rehearsals.hpp"

#include <algorithm>
#include <utility>

namespace lightnet {
namespace {

constexpr std::uint32_t tiles_per_place = 4;  // of a rehearsal: small ones, or bundles of them
constexpr double least_patience = 0.5;        // seconds

}  // namespace

// Copies that wait for a rehearsal, all for the same one: results of calls before it are there.
std::set<NodeCopy> Rehearsals::waiting() {
    std::set<NodeCopy> waiting;
    for (const auto& copy : at_.state.copies(at_.state.done)) {
        const auto& follower = at_.state.followers[copy];
        if (follower.state == Follower::State::waiting && follower.at.kind == StepReport::Kind::rehearse &&
            !at_.calls.reported(copy.node, follower.at).done())
            waiting.insert(copy);
    }
    return waiting;
}

// Those who take part are known when it begins, so it waits a little for those who would come in its middle, and as
// long as it takes for those who may be asked already.
bool Rehearsals::is_time(const std::set<NodeCopy>& waiting) {
    const auto& state = at_.state;
    const double now = steady_seconds();
    if (waiting.empty()) first_waits_.reset();
    if (waiting.empty() || waiting.size() == state.copies(state.done).size()) return !waiting.empty();
    const bool all_nodes = std::ranges::all_of(state.order.nodes_at(state.done), [&](std::size_t node) {
        return std::ranges::any_of(waiting, [&](const auto& copy) { return copy.node == node; });
    });
    if (!first_waits_) first_waits_ = now;
    const auto asked = state.copies_in_force(state.done);
    return all_nodes && std::includes(waiting.begin(), waiting.end(), asked.begin(), asked.end()) &&
           now - *first_waits_ > std::max(least_patience, (*first_waits_ - state.went_on) / 2);
}

bool Rehearsals::advance() {
    const auto done = at_.state.done;
    if (at_.state.all_done()) return false;
    if (!now_) {
        const auto ready = waiting();
        if (!is_time(ready)) return false;
        begin(ready);
        return true;
    }
    for (const auto& copy : now_->copies())
        if (now_->wants_notes_of(copy) &&
            at_.steps.send(
                {copy, done, {.kind = Step::Kind::collect, .call = now_->call(), .first = at_.epoch.number()}}))
            now_->asked(copy);
    return false;
}

void Rehearsals::begin(const std::set<NodeCopy>& taking_part) {
    const auto& state = at_.state;
    const auto call = state.followers.at(*taking_part.begin()).at.call;
    const auto stride = at_.calls.of(state.order.node(state.done), call).what().count;
    first_waits_.reset();
    MasterRenderer::Job job;
    job.run = at_.run;
    job.image = static_cast<std::uint32_t>(renderer_of(state.graph, at_.registry));
    job.width = at_.width;
    job.tiles = rehearsal_tiles(state.graph, at_.registry, stride, pass_of_call(call));
    job.credit = {tiles_per_place, tiles_per_place * MasterRenderer::most_together};
    job.double_tail = false;  // what is still under way at its end would note questions in the next rehearsal
    at_.epoch.begin_next();
    now_ = std::make_unique<ConductedRehearsal>(call, taking_part, std::move(job), at_.carrier);
}

bool Rehearsals::render(std::chrono::nanoseconds most) {
    const bool renders = now_ && !now_->rendered();
    if (renders) now_->render(most);
    if (now_ && now_->broken()) end();
    return renders;
}

void Rehearsals::break_off() {
    if (now_) now_->break_off();
}

// Nobody will ask a place that holds the node no more what it has noted.
void Rehearsals::keep() {
    if (!now_) return;
    const auto holders = at_.state.copies(at_.state.done);
    const auto is_there = [&](const auto& copy) { return std::ranges::find(holders, copy) != holders.end(); };
    if (!std::ranges::all_of(now_->copies(), is_there)) now_->break_off();
}

// What was noted in one that was broken off, perhaps of the same call, does not count.
bool Rehearsals::noted(const SentStep& sent, const Bytes& data) {
    if (!now_ || now_->broken() || sent.step.first != at_.epoch.number() || !now_->collect(data)) return false;
    const auto result = now_->result();
    const auto node = at_.state.order.node(sent.position);
    end();
    at_.calls.of(node, sent.step.call).complete(result);
    at_.calls.keep(node, sent.step.call);
    at_.state.goes_on();
    return true;
}

void Rehearsals::end() {
    now_.reset();
    at_.epoch.begin_next();
}

void Rehearsals::tell(PrepareProgress& progress) const {
    if (now_) progress.done = now_->blocks_done(), progress.total = now_->blocks();
}

}  // namespace lightnet
