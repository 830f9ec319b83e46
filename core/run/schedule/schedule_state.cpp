#include "core/run/schedule/schedule_state.hpp"

#include <algorithm>

namespace lightnet {

ScheduleState::ScheduleState(const ScheduleTerms::Rules& its_rules)
    : rules(its_rules),
      suspects(static_cast<std::size_t>(its_rules.deaths_alone)),
      book(its_rules.strategy == Strategy::affinity),
      order({book, in_flight, suspects}) {}

void ScheduleState::refresh(ScheduleIds::Replica replica) {
    order.refresh(replica);
    refresh_due(replica);
}

void ScheduleState::refresh_all() {
    for (ScheduleIds::Replica replica = 0; replica < book.end(); ++replica) refresh(replica);
}

void ScheduleState::refresh_due(ScheduleIds::Replica replica) {
    Stragglers::Due due;
    for (const auto& copy : in_flight.of(replica).copies) {
        due.overdue = std::min(due.overdue, copy.overdue);
        if (!rules.double_tail || !may_be_doubled(copy)) continue;
        if (book[replica].within_process && book.elsewhere() == 0) continue;
        due.late = std::min(due.late, copy.late);
        if (copy.expected < TournamentTree::none) due.last = std::max(due.last, copy.expected);
    }
    stragglers.set(replica, due);
}

bool ScheduleState::may_be_doubled(const InFlight::Copy& copy) const {
    const auto* const item = backlog.find(copy.work);
    return item && item->work.not_at.empty() && !suspects.is_suspect(copy.work) && item->copies.size() == 1;
}

double ScheduleState::late_after(double expected) const {
    return std::max(std::max(rules.late, order.times().spread()) * expected, expected + rules.worth);
}

void ScheduleState::send(Item& item, ScheduleIds::Replica replica, ScheduleIds::Time now) {
    backlog.sent(item);
    const auto& state = book[replica];
    const bool known = order.times().any();
    const double seconds = order.completion_time(replica, item.work.questions);
    const double expected = known ? seconds : rules.guess;
    const double most = known ? rules.late_factor * order.times().spread() * seconds : rules.patience_at_first;
    const double patience = state.within_process ? TournamentTree::none : std::max(state.patience, most);
    const auto id = in_flight.open(replica, {.work = item.work.work,
                                             .questions = item.work.questions,
                                             .bytes = item.work.bytes,
                                             .sent = now,
                                             .expected = known ? now + expected : TournamentTree::none,
                                             .late = now + late_after(expected),
                                             .overdue = now + patience,
                                             .patience = patience});
    item.copies.push_back(id);
    refresh(replica);
    for (const auto other : item.copies)
        if (other != id) refresh_due(*in_flight.replica_of(other));
    actions->push_back(ScheduleTerms::Send{id, item.work.work, replica});
}

void ScheduleState::wait_again(Item& item) {
    backlog.wait(item);
    const auto work = item.work.work;
    if (suspects.is_suspect(work))
        suspects.wait(work);
    else if (item.failures > 0 || !item.work.not_at.empty())
        backlog.queues.retries.push_back(work);
    else if (!item.written_off.empty())
        backlog.queues.overdue.push_back(work);
    else
        backlog.queues.first.push_front(work);
}

void ScheduleState::ask_again(Item& item) {
    if (!item.under_way_or_waiting()) wait_again(item);
}

void ScheduleState::finish(ScheduleIds::WorkId work) {
    const Item item = backlog.take(work);
    suspects.forget(work);
    for (const auto copy : item.copies) refresh_due(*in_flight.replica_of(copy));
}

}  // namespace lightnet
