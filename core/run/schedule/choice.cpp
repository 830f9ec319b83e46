#include "core/run/schedule/choice.hpp"

#include <algorithm>
#include <vector>

namespace lightnet {
namespace {

using Replica = ScheduleIds::Replica;
using Item = Backlog::Item;

constexpr double overloaded = 4;  // times the completion of the best: then work leaves its home

// The first in order, but rather one that has not got this work already.
Replica best_for(ScheduleState& state, const Item& item) {
    std::vector<Replica> holders;
    for (const auto* copies : {&item.copies, &item.written_off})
        for (const auto copy : *copies) holders.push_back(*state.in_flight.replica_of(copy));
    return state.order.first_open_but(holders);
}

// A slow replica gets nothing that the others together would have answered sooner without it.
// DECISIONS: nothing-for-the-slowest
bool better_held_back(const ScheduleState& state, const Item& item, Replica replica) {
    if (!item.written_off.empty()) return false;  // the fast ones have had their chance
    const auto& order = state.order;
    const auto quickest = order.quickest();
    if (order.times().of(replica) == 0 || !quickest || *quickest == replica) return false;
    const auto left = static_cast<double>(state.backlog.questions().wanted + state.backlog.questions().foreseen);
    const auto questions = item.work.questions;
    const double sooner = order.completion_time(*quickest, questions);
    return order.completion_time(replica, questions) > std::max(left / order.times().rate(), sooner);
}

// Behind other work, the last of a phase would keep all waiting: it is better off with who is idle next.
// DECISIONS: last-to-idle
bool waits_for_idle(const ScheduleState& state, const Item& item, Replica replica) {
    const auto& order = state.order;
    if (state.rules.strategy == Strategy::affinity || !item.written_off.empty() || order.has_idle_place(replica))
        return false;
    const auto& questions = state.backlog.questions();
    if (questions.waiting + questions.foreseen > state.book.places()) return false;
    return !order.times().any() || order.completion_time(replica, 0) > state.rules.worth;
}

// Home, if that takes more work and is not overloaded; else `best`.
Replica home_or(ScheduleState& state, const Item& item, Replica best) {
    const auto home = state.book.home(item.work.region);
    if (home == best) return best;
    const auto questions = item.work.questions;
    if (state.order.is_open(home) && item.written_off.empty() &&
        state.order.completion_time(home, questions) <= overloaded * state.order.completion_time(best, questions))
        return home;
    ++state.counts.spilled;
    return best;
}

}  // namespace

std::optional<Replica> choose(ScheduleState& state, const Item& item) {
    if (!state.order.first_open()) return std::nullopt;
    auto best = best_for(state, item);
    if (state.rules.last_to_idle && waits_for_idle(state, item, best)) {
        const auto idle = state.order.first_idle();
        if (!idle || idle == state.book.reserve()) return std::nullopt;
        best = *idle;
    }
    if (state.rules.strategy == Strategy::affinity && state.book.has_homes()) return home_or(state, item, best);
    const bool fastest = state.rules.strategy == Strategy::fastest;
    return fastest && better_held_back(state, item, best) ? std::nullopt : std::optional(best);
}

}  // namespace lightnet
