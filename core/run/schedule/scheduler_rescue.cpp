// What the scheduler does when answers stay away: overdue work, the end of a phase, suspects.
#include <algorithm>
#include <set>

#include "core/run/schedule/scheduler.hpp"

namespace lightnet {

// An overdue copy gives its credit back, and its work is asked again: its place may hang, or the network may have lost
// it. If the answer comes after all, and first, it counts.
// DECISIONS: overdue-is-written-off
void Scheduler::write_off_overdue(Time now) {
    while (overdue_.least() <= now) {
        const auto replica = static_cast<Replica>(overdue_.first());
        auto& place = places_[replica];
        const auto first = std::min_element(place.copies.begin(), place.copies.end(),
                                            [](const Copy& a, const Copy& b) { return a.overdue < b.overdue; });
        const Copy copy = take_copy(replica, first->id);
        if (place.last_reply <= copy.sent) {
            place.silent = true;
            place.patience = std::max(place.patience, 2 * (now - copy.sent));
        }
        refresh(replica);
        ++counts_.written_off;
        out_.at(copy.id).written_off = true;
        place.strays.push_back(copy.id);
        ++sites_.at(place.host).strays;
        if (!copy.item) continue;
        std::erase(copy.item->copies, copy.id);
        copy.item->written_off.push_back(copy.id);
        ask_again(*copy.item);
    }
}

// At the end of a phase idle replicas do once more what will otherwise come last.
void Scheduler::double_tail(Time now) {
    if (!waiting_.empty() || !suspects_.empty() || foreseen_ > 0) return;
    const auto most = std::max(4.0, rules_.tail_part * static_cast<double>(added_));
    while (open_.any() && static_cast<double>(counts_.doubled) < most) {
        const auto idle = static_cast<Replica>(open_.first());
        if (!places_[idle].copies.empty() || service_of(places_[idle]) == 0) return;
        const Copy* copy = worth_doubling(idle, now);
        if (!copy) return;
        ++counts_.doubled;
        send(*copy->item, idle, now);
    }
}

// ---- failures ----

// Does another host hold it that has not failed, and is not leaving?
bool Scheduler::can_be_retried(const Item& item) const {
    constexpr int most_failures = 3;  // of suspects, which may come to the same host again
    return item.failed_at.size() < 2 && item.failures < most_failures &&
           std::any_of(sites_.begin(), sites_.end(), [&](const auto& site) {
               const auto& replicas = site.second.replicas;
               return !item.failed_at.contains(site.first) &&
                      std::any_of(replicas.begin(), replicas.end(),
                                  [&](auto replica) { return !places_[replica].draining; });
           });
}

// What failed once is asked of another host; what fails there as well is the work's own fault, and not a host's.
void Scheduler::fail(Item& item) {
    const bool under_way = !item.copies.empty() || item.waiting;
    if (item.failed_at.size() >= 2 || (!under_way && !can_be_retried(item))) {
        actions_->push_back(GiveUp{item.work.work});
        return finish(item);
    }
    ++counts_.retried;
    actions_->push_back(Retry{item.work.work});
    if (!under_way) wait_again(item);
}

void Scheduler::retry(Time now) {
    for (auto left = retries_.size(); left > 0; --left) {
        const auto work = retries_.front();
        retries_.pop_front();
        const auto found = items_.find(work);
        if (found == items_.end() || !found->second.waiting) continue;
        auto& item = found->second;
        std::optional<Replica> best;
        for (const auto& [host, site] : sites_)
            for (const auto replica : site.replicas)
                if (!item.failed_at.contains(host) && open(places_[replica]) &&
                    (!best || order(places_[replica]) < order(places_[*best])))
                    best = replica;
        if (best) {
            send(item, *best, now);
        } else if (can_be_retried(item)) {
            retries_.push_back(work);
        } else {
            actions_->push_back(GiveUp{work});
            finish(item);
        }
    }
}

// ---- suspects ----

// Some hosts, at most half of them, get nothing else until they are empty; then suspects, one by one.
// DECISIONS: suspects-alone
void Scheduler::test_suspects(Time now) {
    const auto stale = [&](WorkId work) {
        const auto found = items_.find(work);
        return found == items_.end() || !found->second.waiting;
    };
    while (!suspects_.empty() && stale(suspects_.front())) suspects_.pop_front();
    if (suspects_.empty()) return release_hosts();
    std::erase_if(quarantined_, [&](Host host) {  // none that drain will ever be asked: suspects must not wait for them
        const auto& replicas = sites_.at(host).replicas;
        return std::all_of(replicas.begin(), replicas.end(), [&](auto replica) { return places_[replica].draining; });
    });
    const auto wanted = std::min(suspects_.size(), std::max(std::size_t{1}, sites_.size() / 2));
    while (quarantined_.size() < wanted && open_.any()) quarantine(places_[open_.first()].host);
    for (const auto host : quarantined_) {
        const auto& site = sites_.at(host);
        if (site.copies > 0) continue;
        const auto usable = std::find_if(site.replicas.begin(), site.replicas.end(), [&](Replica replica) {
            return !places_[replica].draining && !places_[replica].refused;
        });
        if (usable == site.replicas.end()) continue;
        while (!suspects_.empty() && stale(suspects_.front())) suspects_.pop_front();
        if (suspects_.empty()) return;
        auto& item = items_.at(suspects_.front());
        suspects_.pop_front();
        send(item, *usable, now);
    }
}

void Scheduler::quarantine(Host host) {
    quarantined_.insert(host);
    for (const auto replica : sites_.at(host).replicas) refresh(replica);
}

void Scheduler::release_hosts() {
    for (const auto host : std::set<Host>(quarantined_)) {
        if (sites_.at(host).copies > 0) continue;
        quarantined_.erase(host);
        for (const auto replica : sites_.at(host).replicas) refresh(replica);
    }
}

}  // namespace lightnet
