#include "core/run/schedule/tail_doubling.hpp"

#include <algorithm>

namespace lightnet {

bool TailDoubling::is_tail() const {
    return state_.rules.double_tail && state_.backlog.queues.first.empty() && state_.suspects.empty() &&
           state_.backlog.questions().foreseen == 0;
}

bool TailDoubling::may_be_afforded(std::size_t questions, double saves) const {
    const auto doubled = static_cast<double>(state_.questions_doubled + questions);
    return doubled <= state_.rules.tail_part * static_cast<double>(state_.backlog.questions().added) ||
           (state_.counts.doubled < state_.rules.tail_least && saves >= state_.rules.tail_saves);
}

TailDoubling::Time TailDoubling::next_tick() const {
    const auto& rules = state_.rules;
    if (!state_.order.first_idle() || !is_tail() || !may_be_afforded(1, rules.tail_saves)) return TournamentTree::none;
    return state_.stragglers.late() + (may_be_afforded(1, 0) ? 0 : rules.tail_saves);
}

// Seconds, as far as can be foreseen: who is late already may be so for as long again.
double TailDoubling::saved_by(Replica idle, const InFlight::Copy& copy, Time now) const {
    if (copy.late <= now) return now - copy.late;
    return copy.expected - now - state_.order.completion_time(idle, copy.questions);
}

// A copy at `replica` that `idle` may do once more.
template <class IsMeant>
const InFlight::Copy* TailDoubling::find(Replica replica, Replica idle, const IsMeant& is_meant) const {
    const auto& book = state_.book;
    if (book[replica].within_process && book[idle].within_process) return nullptr;
    for (const auto& copy : state_.in_flight.of(replica).copies)
        if (state_.may_be_doubled(copy) && is_meant(copy) &&
            !state_.backlog.find(copy.work)->failed_at.contains(book[idle].host))
            return &copy;
    return nullptr;
}

// What `idle` could do: a copy that is late, if `idle` takes no longer than it was to take; else the one that is
// expected last, if `idle` would win more time than it spends.
const InFlight::Copy* TailDoubling::worth_doubling(Replica idle, Time now) const {
    const auto& stragglers = state_.stragglers;
    const auto needs = [&](const InFlight::Copy& copy) { return state_.order.completion_time(idle, copy.questions); };
    if (const Time late = stragglers.late(); late <= now)
        if (const auto* copy = find(stragglers.late_at(), idle, [&](const auto& one) { return one.late == late; });
            copy && needs(*copy) <= copy->expected - copy->sent)
            return copy;
    const Time last = stragglers.last();
    if (state_.order.times().of(idle) == 0 || last == -TournamentTree::none) return nullptr;
    const auto* copy = find(stragglers.last_at(), idle, [&](const auto& one) { return one.expected == last; });
    return copy && now + 2 * needs(*copy) + state_.rules.worth < last ? copy : nullptr;
}

void TailDoubling::double_tail(Time now) {
    while (is_tail()) {
        auto idle = state_.order.first_idle();
        const auto* copy = idle ? worth_doubling(*idle, now) : nullptr;
        if (!copy && idle && state_.book[*idle].within_process) {
            idle = state_.order.first_idle_elsewhere();
            copy = idle ? worth_doubling(*idle, now) : nullptr;
        }
        if (!copy || !may_be_afforded(copy->questions, saved_by(*idle, *copy, now))) return;
        ++state_.counts.doubled;
        state_.questions_doubled += copy->questions;
        state_.send(*state_.backlog.find(copy->work), *idle, now);
    }
}

}  // namespace lightnet
