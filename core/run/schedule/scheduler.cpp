#include "core/run/schedule/scheduler.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace lightnet {

// DECISIONS: one-state-machine
void Scheduler::on(const Event& event, Time now, std::vector<Action>& actions) {
    actions_ = &actions;
    std::visit([&](const auto& what) { happens(what, now); }, event);
}

// ---- work comes and goes ----

void Scheduler::happens(const Added& event, Time) {
    assert(!items_.contains(event.work) && "work goes by numbers of its own");
    items_.emplace(event.work, Item{.work = event, .waiting = true});
    (event.not_at.empty() ? waiting_ : retries_).push_back(event.work);
    questions_waiting_ += event.questions;
    questions_added_ += event.questions;
    questions_wanted_ += event.questions;
    note_size(event.questions);
}

void Scheduler::happens(const Dropped&, Time) {
    for (const auto& queue :
         {std::exchange(waiting_, {}), std::exchange(overdue_, {}), suspects_.drop(), std::exchange(retries_, {})})
        for (const auto work : queue)
            if (waiting_item(work)) finish(work);
    foreseen_ = 0;
    rules_.double_tail = false;  // what is left is waited for, and not worth doing twice
}

void Scheduler::happens(const Forgotten& event, Time) {
    if (items_.contains(event.work)) finish(event.work);
}

bool Scheduler::is_at(WorkId work, Replica replica) const {
    const auto found = items_.find(work);
    return found != items_.end() && std::ranges::any_of(found->second.copies, [&](CopyId copy) {
               return in_flight_.replica_of(copy) == replica;
           });
}

bool Scheduler::is_under_way(WorkId work) const {
    const auto found = items_.find(work);
    return found != items_.end() && !found->second.copies.empty();
}

Scheduler::Item* Scheduler::waiting_item(WorkId work) {
    const auto found = items_.find(work);
    return found == items_.end() || !found->second.waiting ? nullptr : &found->second;
}

void Scheduler::wait_again(Item& item) {
    item.waiting = true;
    questions_waiting_ += item.work.questions;
    if (suspects_.is_suspect(item.work.work))
        suspects_.wait(item.work.work);
    else if (item.failures > 0 || !item.work.not_at.empty())
        retries_.push_back(item.work.work);
    else if (!item.written_off.empty())
        overdue_.push_back(item.work.work);
    else
        waiting_.push_front(item.work.work);
}

// Forgets about work. What is still under way of it keeps its credit until it is answered or overdue.
void Scheduler::finish(WorkId work) {
    const Item item = std::move(items_.extract(work).mapped());  // it may stand in a queue; it is skipped there
    if (item.waiting) questions_waiting_ -= item.work.questions;
    questions_wanted_ -= item.work.questions;
    suspects_.forget(work);
    for (const auto copy : item.copies) refresh_due(*in_flight_.replica_of(copy));
}

// ---- replicas come and go ----

void Scheduler::happens(const Joined& event, Time) {
    if (event.replica >= replicas_.size()) replicas_.resize(event.replica + 1);
    auto& replica = replicas_[event.replica];
    assert(!replica.present && "a replica joins once");
    replica = {};
    replica.present = true;
    replica.host = event.host;
    replica.name = event.name;
    replica.process = event.process;
    replica.credit = event.credit;
    replica.places = event.places;
    replica.reserve = event.reserve;
    replica.within_process = event.within_process;
    if (event.reserve) reserve_ = event.replica;
    replica.patience = rules_.patience;
    times_.forget(event.replica);
    hosts_[event.host].insert(event.replica);
    ++present_;
    places_ += event.places;
    elsewhere_ += !event.within_process;
    for (const auto work : suspects_.came_back(event.host, event.process))
        if (waiting_item(work)) waiting_.push_front(work);
    at_home(event.replica);
    refresh(event.replica);
    if (elsewhere_ == 1 && !event.within_process)  // who may do twice what is within the process
        for (Replica other = 0; other < replicas_.size(); ++other) refresh_due(other);
}

// Regions belong to it from now on: where they count. What the asker keeps in reserve is nobody's home.
void Scheduler::at_home(Replica replica) {
    const auto& state = replicas_[replica];
    if (rules_.strategy == Strategy::affinity && !state.reserve) homes_.add(replica, state.name, state.places);
}

void Scheduler::happens(const Resized& event, Time) {
    auto& replica = replicas_.at(event.replica);
    if (!replica.present) return;
    homes_.remove(event.replica, replica.name, replica.places);
    places_ = places_ - replica.places + event.places;
    replica.places = event.places;
    replica.credit = event.credit;
    if (!replica.draining) at_home(event.replica);
    refresh(event.replica);
}

void Scheduler::happens(const Draining& event, Time) {
    auto& replica = replicas_.at(event.replica);
    if (!replica.present || replica.draining == event.draining) return;
    replica.draining = event.draining;
    if (event.draining)
        homes_.remove(event.replica, replica.name, replica.places);
    else
        at_home(event.replica);
    refresh(event.replica);
}

void Scheduler::happens(const Gone& event, Time) {
    std::map<Host, std::size_t> had;  // when it died: its replicas go together
    for (const auto replica : event.replicas) had[replicas_.at(replica).host] = under_way(replicas_[replica].host);
    for (const auto replica : event.replicas)
        if (replicas_[replica].present) go(replica, event.died, had[replicas_[replica].host] == 1);
}

std::size_t Scheduler::under_way(Host host) const {
    std::size_t copies = 0;
    if (const auto found = hosts_.find(host); found != hosts_.end())
        for (const auto replica : found->second) copies += in_flight_.of(replica).size();
    return copies;
}

void Scheduler::go(Replica replica, bool died, bool alone) {
    auto& state = replicas_[replica];
    const InFlight::Account had = in_flight_.close_all(replica);
    for (const auto& [copy, work] : had.written_off)
        if (const auto item = items_.find(work); item != items_.end()) std::erase(item->second.written_off, copy);
    const Suspects::Loss loss{state.host, state.process, alone};
    if (died) suspects_.lost(loss.host, loss.process);
    homes_.remove(replica, state.name, state.places);
    state.present = false;
    if (state.reserve) reserve_.reset();
    --present_;
    places_ -= state.places;
    elsewhere_ -= !state.within_process;
    auto& of_host = hosts_.at(loss.host);
    of_host.erase(replica);
    if (of_host.empty()) {
        hosts_.erase(loss.host);
        suspects_.release(loss.host);
    }
    refresh(replica);
    for (auto copy = had.copies.rbegin(); copy != had.copies.rend(); ++copy) {
        const auto found = items_.find(copy->work);
        if (found == items_.end()) continue;
        auto& item = found->second;
        ++counts_.asked_again;
        std::erase(item.copies, copy->id);
        if (died)
            blame(item, loss);
        else
            ask_again(item);
    }
}

void Scheduler::ask_again(Item& item) {
    if (item.copies.empty() && !item.waiting) wait_again(item);
}

void Scheduler::blame(Item& item, const Suspects::Loss& loss) {
    const auto work = item.work.work;
    if (!suspects_.blame(work, loss)) return ask_again(item);
    actions_->push_back(SetAside{work, suspects_.died_alone(work)});
    finish(work);
}

// ---- copies come back ----

// What the copy was of, which does not count it any more; null: that is done.
Scheduler::Item* Scheduler::item_of(const InFlight::Closed& closed) {
    const auto found = items_.find(closed.work);
    return found == items_.end() ? nullptr : &found->second;
}

void Scheduler::happens(const Replied& event, Time now) {
    const auto closed = in_flight_.close(event.copy);
    if (!closed) return actions_->push_back(Drop{event.copy});
    auto& replica = replicas_[closed->replica];
    if (closed->copy) measure(closed->replica, *closed->copy, event, now);
    const bool is_first = !times_.any();
    const auto& account = in_flight_.of(closed->replica);
    replica.others = event.fill > account.questions ? event.fill - account.questions : 0;
    replica.last_reply = replica.last_sign = now;
    replica.silent = false;
    replica.patience = rules_.patience;
    Item* item = item_of(*closed);
    if (item) std::erase(closed->copy ? item->copies : item->written_off, event.copy);
    refresh(closed->replica);
    if (is_first && times_.any()) expect_again(now);
    if (!item) return actions_->push_back(Drop{event.copy});
    actions_->push_back(Accept{event.copy, closed->work});
    finish(closed->work);
}

// The first answer tells about how long what was sent before it will take.
void Scheduler::expect_again(Time now) {
    for (Replica replica = 0; replica < replicas_.size(); ++replica) {
        if (in_flight_.of(replica).copies.empty()) continue;
        in_flight_.expect(replica, [&](InFlight::Copy& copy) {
            copy.expected = now + completion_time(replica, 0);
            copy.late = copy.sent + late_after(copy.expected - copy.sent);
        });
        refresh_due(replica);
    }
}

// A replica that was never idle has spent on this copy what has passed since its last reply: so many places at once.
void Scheduler::measure(Replica replica, const InFlight::Copy& copy, const Replied& reply, Time now) {
    const double seconds = std::max(now - std::max(copy.sent, replicas_[replica].last_reply), 0.0);
    const auto at_work = std::min<std::size_t>(replicas_[replica].places, in_flight_.of(replica).copies.size() + 1);
    times_.measure(replica, static_cast<double>(at_work) * seconds, reply.answered ? reply.answered : copy.questions,
                   reply.service);
}

void Scheduler::happens(const Failed& event, Time now) {
    const auto closed = in_flight_.close(event.copy);
    if (!closed) return actions_->push_back(Drop{event.copy});
    Item* item = item_of(*closed);
    if (item) std::erase(closed->copy ? item->copies : item->written_off, event.copy);
    auto& replica = replicas_[closed->replica];
    replica.last_reply = replica.last_sign = now;
    replica.silent = false;
    refresh(closed->replica);
    if (!item) return actions_->push_back(Drop{event.copy});
    item->failed_at.insert(replica.host);
    ++item->failures;
    fail(*item);
}

void Scheduler::happens(const Alive& event, Time now) { replicas_.at(event.replica).last_sign = now; }

void Scheduler::happens(const Refused& event, Time) {
    const auto closed = in_flight_.close(event.copy);
    if (!closed) return;
    auto& replica = replicas_[closed->replica];
    if (!replica.refused) refused_.push_back(closed->replica);
    replica.refused = true;
    refresh(closed->replica);
    Item* item = item_of(*closed);
    if (!item) return;
    std::erase(item->copies, event.copy);
    ask_again(*item);
}

// ---- time to decide ----

void Scheduler::happens(const Tick& event, Time now) {
    if (!event.again)
        for (const auto replica : std::exchange(refused_, {})) {
            replicas_[replica].refused = false;
            refresh(replica);
        }
    write_off_overdue(now);
    test_suspects(now);
    retry(now);
    ask_idle(now);
    hand_out(now);
    double_tail(now);
}

void Scheduler::send(Item& item, Replica replica, Time now) {
    if (item.waiting) questions_waiting_ -= item.work.questions;
    item.waiting = false;
    auto& state = replicas_[replica];
    const bool known = times_.any();
    const double seconds = completion_time(replica, item.work.questions);
    const double expected = known ? seconds : rules_.guess;
    const double most = known ? rules_.late_factor * times_.spread() * seconds : rules_.patience_at_first;
    const double patience = state.within_process ? TournamentTree::none : std::max(state.patience, most);
    const CopyId id = in_flight_.open(replica, {.work = item.work.work,
                                                .questions = item.work.questions,
                                                .bytes = item.work.bytes,
                                                .sent = now,
                                                .expected = known ? now + expected : TournamentTree::none,
                                                .late = now + late_after(expected),
                                                .overdue = now + patience,
                                                .patience = patience});
    if (++state.in_turn >= state.places) state.turn = ++turn_, state.in_turn = 0;
    item.copies.push_back(id);
    refresh(replica);
    for (const auto other : item.copies)
        if (other != id) refresh_due(*in_flight_.replica_of(other));
    actions_->push_back(Send{id, item.work.work, replica});
}

void Scheduler::hand_out(Time now) {
    while (!waiting_.empty()) {
        const auto work = waiting_.front();
        auto* const item = waiting_item(work);
        if (!item) {
            waiting_.pop_front();
        } else if (suspects_.is_suspect(work)) {
            suspects_.wait(work);
            waiting_.pop_front();
        } else {
            const auto replica = choose(*item);
            if (!replica) return;
            waiting_.pop_front();
            send(*item, *replica, now);
        }
    }
}

}  // namespace lightnet
