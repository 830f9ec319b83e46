// The scheduler's rescue of work whose answers stay away: overdue work, failures, suspects.
#include <algorithm>
#include <set>

#include "core/run/schedule/scheduler.hpp"

namespace lightnet {

// An overdue copy gives its credit back, and its work is asked again of who is idle: its place may hang, or the network
// may have lost it. If the answer comes after all, and first, it counts.
// DECISIONS: overdue-is-written-off
void Scheduler::write_off_overdue(Time now) {
    while (stragglers_.next_overdue() <= now) {
        const auto replica = stragglers_.overdue_at();
        if (put_off(replica, now)) continue;
        auto& state = replicas_[replica];
        const auto copy = in_flight_.write_off_first(replica);
        if (state.last_reply <= copy.sent) {
            state.silent = true;
            state.patience = std::max(state.patience, 2 * (now - copy.sent));
        }
        refresh(replica);
        ++counts_.written_off;
        const auto found = items_.find(copy.work);
        if (found == items_.end()) continue;
        auto& item = found->second;
        std::erase(item.copies, copy.id);
        item.written_off.push_back(copy.id);
        ask_again(item);
    }
}

// Who has shown meanwhile that it works is waited for from then on. False: nobody has.
bool Scheduler::put_off(Replica replica, Time now) {
    bool later = false;
    in_flight_.expect(replica, [&](InFlight::Copy& copy) {
        const Time overdue = std::max(copy.sent, replicas_[replica].last_sign) + copy.patience;
        later |= copy.overdue <= now && overdue > now;
        copy.overdue = std::max(copy.overdue, overdue);
    });
    if (later) refresh_due(replica);
    return later;
}

// Overdue work may well be under way: whoever is busy has better things to do.
void Scheduler::ask_idle(Time now) {
    for (auto left = overdue_.size(); left > 0; --left) {
        const auto work = overdue_.front();
        overdue_.pop_front();
        auto* const item = waiting_item(work);
        if (!item) continue;
        if (suspects_.is_suspect(work)) {
            suspects_.wait(work);
        } else if (item->written_off.empty()) {  // who had it is gone
            waiting_.push_front(work);
        } else if (const auto idle = idle_for(*item)) {
            send(*item, *idle, now);
        } else {
            overdue_.push_back(work);
        }
    }
}

// One that has not got this work already, unless nobody else is there.
std::optional<Scheduler::Replica> Scheduler::idle_for(const Item& item) {
    std::set<Replica> holders;
    for (const auto copy : item.written_off) holders.insert(*in_flight_.replica_of(copy));
    if (holders.size() == present_) holders.clear();
    for (const auto holder : holders) idle_.set(holder, TournamentTree::none);
    auto idle = idle_one();
    if (idle && holders.contains(*idle)) idle.reset();  // the reserve
    for (const auto holder : holders) refresh(holder);
    return idle;
}

// ---- failures ----

// Does another host hold it that has not failed, and is not leaving?
bool Scheduler::can_be_retried(const Item& item) const {
    constexpr int most_failures = 3;  // of suspects, which may come to the same host again
    return item.failed_at.size() < 2 && item.failures < most_failures &&
           std::any_of(hosts_.begin(), hosts_.end(), [&](const auto& host) {
               return may_answer(item, host.first) &&
                      std::any_of(host.second.begin(), host.second.end(),
                                  [&](auto replica) { return !replicas_[replica].draining; });
           });
}

// What failed once is asked of another host, as is what some hosts may not answer; what fails there as well is the
// work's own fault, and not a host's.
void Scheduler::fail(Item& item) {
    const auto work = item.work.work;
    const bool under_way = !item.copies.empty() || item.waiting;
    if (item.failed_at.size() >= 2 || (!under_way && !can_be_retried(item))) {
        actions_->push_back(GiveUp{work});
        return finish(work);
    }
    ++counts_.retried;
    actions_->push_back(Retry{work});
    if (!under_way) wait_again(item);
}

void Scheduler::retry(Time now) {
    for (auto left = retries_.size(); left > 0; --left) {
        const auto work = retries_.front();
        retries_.pop_front();
        auto* const item = waiting_item(work);
        if (!item) continue;
        std::optional<Replica> best;
        for (const auto& [host, replicas] : hosts_)
            for (const auto replica : replicas)
                if (may_answer(*item, host) && open(replica) && (!best || order(replica) < order(*best)))
                    best = replica;
        if (best) {
            send(*item, *best, now);
        } else if (can_be_retried(*item)) {
            retries_.push_back(work);
        } else {
            actions_->push_back(GiveUp{work});
            finish(work);
        }
    }
}

// ---- suspects ----

// The first that still waits; null: none does.
Scheduler::Item* Scheduler::first_suspect() {
    for (; !suspects_.empty(); suspects_.pop())
        if (auto* const item = waiting_item(suspects_.front())) return item;
    return nullptr;
}

// Some hosts, at most half of them, get nothing else until they are empty; then suspects, one by one.
// DECISIONS: suspects-alone
void Scheduler::test_suspects(Time now) {
    if (!first_suspect()) return release_hosts();
    for (const auto host : std::set<Host>(suspects_.quarantine())) {
        const auto& replicas = hosts_.at(host);
        if (std::all_of(replicas.begin(), replicas.end(), [&](auto replica) { return replicas_[replica].draining; }))
            suspects_.release(host);  // it will never be asked: suspects must not wait for it
    }
    const auto wanted = std::min(suspects_.waiting(), std::max(std::size_t{1}, hosts_.size() / 2));
    while (suspects_.quarantine().size() < wanted && open_.any()) put_in_quarantine(replicas_[open_.first()].host);
    for (const auto host : suspects_.quarantine()) {
        const auto& replicas = hosts_.at(host);
        const auto usable = std::find_if(replicas.begin(), replicas.end(), [&](auto replica) {
            return !replicas_[replica].draining && !replicas_[replica].refused;
        });
        if (is_busy(host) || usable == replicas.end()) continue;
        auto* const item = first_suspect();
        if (!item) return;
        suspects_.pop();
        send(*item, *usable, now);
    }
}

bool Scheduler::is_busy(Host host) const {
    const auto& replicas = hosts_.at(host);
    return std::any_of(replicas.begin(), replicas.end(),
                       [&](auto replica) { return !in_flight_.of(replica).copies.empty(); });
}

void Scheduler::put_in_quarantine(Host host) {
    suspects_.put_in_quarantine(host);
    for (const auto replica : hosts_.at(host)) refresh(replica);
}

void Scheduler::release_hosts() {
    for (const auto host : std::set<Host>(suspects_.quarantine())) {
        if (is_busy(host)) continue;
        suspects_.release(host);
        for (const auto replica : hosts_.at(host)) refresh(replica);
    }
}

}  // namespace lightnet
