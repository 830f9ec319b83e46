// How the scheduler chooses: what replicas are worth, and in which order they stand.
#include <algorithm>
#include <utility>

#include "core/run/schedule/scheduler.hpp"

namespace lightnet {
namespace {

constexpr double overloaded = 4;  // times the completion of the best: then work leaves its home

}  // namespace

// ---- what a replica is worth ----

double Scheduler::completion_time(Replica replica, std::size_t questions) const {
    return static_cast<double>(ledger_.of(replica).questions + replicas_[replica].others + questions) *
           times_.assumed(replica);
}

bool Scheduler::open(Replica replica) const {
    const auto& state = replicas_[replica];
    const auto& account = ledger_.of(replica);
    if (!state.present || state.draining || state.refused || suspects_.in_quarantine(state.host)) return false;
    if (account.copies.empty()) return true;
    return !state.silent && account.copies.size() < state.credit.bundles &&
           account.questions < state.credit.questions && account.bytes < state.credit.bytes;
}

double Scheduler::order(Replica replica) const {
    const auto ahead = static_cast<double>(ledger_.of(replica).questions + replicas_[replica].others);
    switch (rules_.strategy) {
        case Strategy::round_robin:
            return static_cast<double>(replicas_[replica].turn);
        case Strategy::least_loaded:
            return ahead;
        default: {
            const double service = times_.of(replica);
            return (ahead + static_cast<double>(rules_.usual)) * (service > 0 ? service : ServiceTimes::unknown);
        }
    }
}

// ---- keeping the order ----

void Scheduler::refresh(Replica replica) {
    auto& state = replicas_[replica];
    const bool is_open = open(replica);
    open_.set(replica, is_open ? order(replica) : Lowest::none);
    const bool idle = is_open && ledger_.of(replica).copies.empty();
    idle_ = idle_ + idle - std::exchange(state.counted_idle, idle);

    const bool works =
        state.present && !state.draining && !state.silent && !state.refused && !suspects_.in_quarantine(state.host);
    times_.take_part(replica, works);
    const bool known = works && times_.of(replica) > 0;
    all_.set(replica, known ? completion_time(replica, rules_.usual) : Lowest::none);
    refresh_due(replica);
}

void Scheduler::refresh_due(Replica replica) {
    Stragglers::Due due;
    for (const auto& copy : ledger_.of(replica).copies) {
        due.overdue = std::min(due.overdue, copy.overdue);
        if (!rules_.double_tail || !may_be_doubled(copy)) continue;
        due.first = std::min(due.first, copy.expected);
        due.last = std::max(due.last, copy.expected);
    }
    stragglers_.set(replica, due);
}

// ---- choosing ----

std::optional<Scheduler::Replica> Scheduler::choose(const Item& item) {
    if (!open_.any()) return std::nullopt;
    const auto best = best_for(item);
    if (rules_.strategy == Strategy::affinity && !homes_.empty()) {
        const auto at_home = home(item.work.region);
        const auto questions = item.work.questions;
        if (at_home == best) return best;
        if (open_.key(at_home) < Lowest::none && item.written_off.empty() &&
            completion_time(at_home, questions) <= overloaded * completion_time(best, questions))
            return at_home;
        ++counts_.spilled;
        return best;
    }
    if (rules_.strategy == Strategy::fastest && better_held_back(item, best)) return std::nullopt;
    return best;
}

// The first in order, but rather one that has not got this work already.
Scheduler::Replica Scheduler::best_for(const Item& item) {
    auto best = static_cast<Replica>(open_.first());
    if (item.copies.empty() && item.written_off.empty()) return best;
    std::vector<Replica> holders;
    for (const auto* copies : {&item.copies, &item.written_off})
        for (const auto copy : *copies) holders.push_back(*ledger_.replica_of(copy));
    for (const auto holder : holders) open_.set(holder, Lowest::none);
    if (open_.any()) best = static_cast<Replica>(open_.first());
    for (const auto holder : holders) refresh(holder);
    return best;
}

// A slow replica gets nothing that the others together would have answered sooner without it.
// DECISIONS: nothing-for-the-slowest
bool Scheduler::better_held_back(const Item& item, Replica replica) const {
    if (!item.written_off.empty()) return false;  // the fast ones have had their chance
    if (times_.of(replica) == 0 || !all_.any() || all_.first() == replica) return false;
    const auto left = static_cast<double>(ledger_.questions() + questions_waiting_ + foreseen_);
    const auto questions = item.work.questions;
    const double sooner = completion_time(static_cast<Replica>(all_.first()), questions);
    return completion_time(replica, questions) > std::max(left / times_.rate(), sooner);
}

// ---- speculative execution ----

bool Scheduler::may_be_doubled(const Ledger::Copy& copy) const {
    const auto found = items_.find(copy.work);
    return found != items_.end() && !suspects_.is_suspect(copy.work) && found->second.copies.size() == 1 &&
           copy.expected < Lowest::none;
}

// What `idle` could do: a copy that is late by half of its time, else the one that is expected last, if that is later
// than `idle` would need.
const Ledger::Copy* Scheduler::worth_doubling(Replica idle, Time now) const {
    const auto find = [&](Replica replica, Time expected) -> const Ledger::Copy* {
        for (const auto& copy : ledger_.of(replica).copies)
            if (may_be_doubled(copy) && copy.expected == expected &&
                !items_.at(copy.work).failed_at.contains(replicas_[idle].host))
                return &copy;
        return nullptr;
    };
    if (!stragglers_.any()) return nullptr;
    const auto* first = find(stragglers_.first_at(), stragglers_.first());
    if (first && now > first->expected + 0.5 * (first->expected - first->sent)) return first;
    const auto* last = find(stragglers_.last_at(), stragglers_.last());
    return last && now + 1.1 * completion_time(idle, last->questions) < last->expected ? last : nullptr;
}

// At the end of a phase idle replicas do once more what will otherwise come last.
void Scheduler::double_tail(Time now) {
    if (!waiting_.empty() || !suspects_.empty() || foreseen_ > 0) return;
    const auto most = std::max(4.0, rules_.tail_part * static_cast<double>(added_));
    while (open_.any() && static_cast<double>(counts_.doubled) < most) {
        const auto idle = static_cast<Replica>(open_.first());
        if (!ledger_.of(idle).copies.empty() || times_.of(idle) == 0) return;
        const auto* copy = worth_doubling(idle, now);
        if (!copy) return;
        ++counts_.doubled;
        send(items_.at(copy->work), idle, now);
    }
}

}  // namespace lightnet
