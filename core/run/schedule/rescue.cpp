#include "core/run/schedule/rescue.hpp"

#include <algorithm>
#include <set>
#include <vector>

namespace lightnet {

// Its place may hang, or the network may have lost it. If the answer comes after all, and first, it counts.
// DECISIONS: overdue-is-written-off
void Rescue::write_off_overdue(Time now) {
    while (state_.stragglers.next_overdue() <= now) {
        const auto replica = state_.stragglers.overdue_at();
        if (put_off(replica, now)) continue;
        auto& state = state_.book[replica];
        const auto copy = state_.in_flight.write_off_first(replica);
        if (state.last_reply <= copy.sent) {
            state.silent = true;
            state.patience = std::max(state.patience, 2 * (now - copy.sent));
        }
        state_.refresh(replica);
        ++state_.counts.written_off;
        auto* const item = state_.backlog.find(copy.work);
        if (!item) continue;
        std::erase(item->copies, copy.id);
        item->written_off.push_back(copy.id);
        state_.ask_again(*item);
    }
}

// Who has shown meanwhile that it works is waited for from then on. False: nobody has.
bool Rescue::put_off(Replica replica, Time now) {
    bool later = false;
    state_.in_flight.expect(replica, [&](InFlight::Copy& copy) {
        const Time overdue = std::max(copy.sent, state_.book[replica].last_sign) + copy.patience;
        later |= copy.overdue <= now && overdue > now;
        copy.overdue = std::max(copy.overdue, overdue);
    });
    if (later) state_.refresh_due(replica);
    return later;
}

// Overdue work may well be under way: whoever is busy has better things to do.
void Rescue::ask_idle(Time now) {
    auto& queues = state_.backlog.queues;
    state_.backlog.take_each(queues.overdue, [&](Item& item) {
        const auto work = item.work.work;
        if (state_.suspects.is_suspect(work)) {
            state_.suspects.wait(work);
        } else if (item.written_off.empty()) {  // who had it is gone
            queues.first.push_front(work);
        } else if (const auto idle = idle_for(item)) {
            state_.send(item, *idle, now);
        } else {
            queues.overdue.push_back(work);
        }
    });
}

// One that has not got this work already, unless nobody else is there.
std::optional<Rescue::Replica> Rescue::idle_for(const Item& item) {
    std::set<Replica> holders;
    for (const auto copy : item.written_off) holders.insert(*state_.in_flight.replica_of(copy));
    if (holders.size() == state_.book.present()) holders.clear();
    return state_.order.first_idle_but(std::vector(holders.begin(), holders.end()));
}

// ---- failures ----

// Does another host hold it that has not failed, and is not leaving? Or may one come?
bool Rescue::can_be_retried(const Item& item) const {
    constexpr int most_failures = 3;  // of suspects, which may come to the same host again
    if (item.failed_at.size() >= 2 || item.failures >= most_failures) return false;
    return state_.more_hosts || std::ranges::any_of(state_.book.on_hosts(), [&](const auto& host) {
               return item.may_be_answered_at(host.first) &&
                      std::ranges::any_of(host.second, [&](auto replica) { return !state_.book[replica].draining; });
           });
}

// What failed once is asked of another host, as is what some hosts may not answer; what fails there as well is the
// work's own fault, and not a host's.
void Rescue::fail(Item& item) {
    const auto work = item.work.work;
    const bool goes_on = item.under_way_or_waiting();
    if (item.failed_at.size() >= 2 || (!goes_on && !can_be_retried(item))) {
        return give_up(work);
    }
    ++state_.counts.retried;
    state_.actions->push_back(ScheduleTerms::Retry{work});
    if (!goes_on) state_.wait_again(item);
}

void Rescue::give_up(ScheduleIds::WorkId work) {
    state_.actions->push_back(ScheduleTerms::GiveUp{work});
    state_.finish(work);
}

void Rescue::retry(Time now) {
    auto& retries = state_.backlog.queues.retries;
    state_.backlog.take_each(retries, [&](Item& item) {
        const auto work = item.work.work;
        if (const auto best = best_allowed(item)) {
            state_.send(item, *best, now);
        } else if (can_be_retried(item)) {
            retries.push_back(work);
        } else {
            give_up(work);
        }
    });
}

// The first in order of those that may answer it now.
std::optional<Rescue::Replica> Rescue::best_allowed(const Item& item) const {
    const auto& order = state_.order;
    std::optional<Replica> best;
    for (const auto& [host, replicas] : state_.book.on_hosts())
        for (const auto replica : replicas)
            if (item.may_be_answered_at(host) && order.is_open(replica) &&
                (!best || order.key(replica) < order.key(*best)))
                best = replica;
    return best;
}

// ---- suspects ----

// The first that still waits; null: none does.
Rescue::Item* Rescue::first_suspect() {
    for (auto& suspects = state_.suspects; !suspects.empty(); suspects.pop())
        if (auto* const item = state_.backlog.find_waiting(suspects.front())) return item;
    return nullptr;
}

// Some hosts, at most half of them, get nothing else until they are empty; then suspects, one by one.
// DECISIONS: suspects-alone
void Rescue::test_suspects(Time now) {
    if (!first_suspect()) return release_hosts();
    auto& suspects = state_.suspects;
    const auto& book = state_.book;
    for (const auto host : std::set<Host>(suspects.quarantine()))
        if (std::ranges::all_of(book.on_hosts().at(host), [&](auto replica) { return book[replica].draining; }))
            suspects.release(host);  // it will never be asked: suspects must not wait for it
    const auto wanted = std::min(suspects.waiting(), std::max(std::size_t{1}, book.on_hosts().size() / 2));
    while (suspects.quarantine().size() < wanted && state_.order.first_open())
        put_in_quarantine(book[*state_.order.first_open()].host);
    for (const auto host : suspects.quarantine()) {
        const auto& replicas = book.on_hosts().at(host);
        const auto usable = std::ranges::find_if(
            replicas, [&](auto replica) { return !book[replica].draining && !book[replica].refused; });
        if (is_busy(host) || usable == replicas.end()) continue;
        auto* const item = first_suspect();
        if (!item) return;
        suspects.pop();
        state_.send(*item, *usable, now);
    }
}

bool Rescue::is_busy(Host host) const {
    return std::ranges::any_of(state_.book.on_hosts().at(host),
                               [&](auto replica) { return !state_.in_flight.of(replica).copies.empty(); });
}

void Rescue::put_in_quarantine(Host host) {
    state_.suspects.put_in_quarantine(host);
    for (const auto replica : state_.book.on_hosts().at(host)) state_.refresh(replica);
}

void Rescue::release_hosts() {
    for (const auto host : std::set<Host>(state_.suspects.quarantine())) {
        if (is_busy(host)) continue;
        state_.suspects.release(host);
        for (const auto replica : state_.book.on_hosts().at(host)) state_.refresh(replica);
    }
}

}  // namespace lightnet
