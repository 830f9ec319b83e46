#include "core/run/schedule/scheduler.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace lightnet {
namespace {

constexpr double fading = 0.8;  // how much of the past a measurement keeps with each new one

}  // namespace

// DECISIONS: one-state-machine
void Scheduler::on(const Event& event, Time now, std::vector<Action>& actions) {
    actions_ = &actions;
    std::visit([&](const auto& what) { happens(what, now); }, event);
}

std::optional<Scheduler::Replica> Scheduler::replica_of(CopyId copy) const {
    const auto found = out_.find(copy);
    return found == out_.end() ? std::nullopt : std::optional(found->second.replica);
}

std::optional<Scheduler::WorkId> Scheduler::work_of(CopyId copy) const {
    const auto found = out_.find(copy);
    return found == out_.end() ? std::nullopt : std::optional(found->second.work);
}

// ---- work comes and goes ----

void Scheduler::happens(const Added& event, Time) {
    assert(!items_.contains(event.work) && "work goes by numbers of its own");
    items_.emplace(event.work, Item{.work = event, .waiting = true});
    waiting_.push_back(event.work);
    questions_waiting_ += event.questions;
    ++added_;
}

void Scheduler::happens(const Dropped&, Time) {
    for (auto* queue : {&waiting_, &suspects_, &retries_}) {
        for (const auto work : *queue)
            if (const auto found = items_.find(work); found != items_.end() && found->second.waiting)
                finish(found->second);
        queue->clear();
    }
    foreseen_ = 0;
    rules_.double_tail = false;  // what is left is waited for, and not worth doing twice
}

void Scheduler::wait_again(Item& item) {
    item.waiting = true;
    questions_waiting_ += item.work.questions;
    if (item.suspect())
        suspects_.push_back(item.work.work);
    else if (item.failures > 0)
        retries_.push_back(item.work.work);
    else
        waiting_.push_front(item.work.work);
}

// Forgets about work. What is still under way of it keeps its credit until it is answered or overdue.
void Scheduler::finish(Item& item) {
    if (item.waiting) questions_waiting_ -= item.work.questions;
    for (const auto id : item.copies) {
        const auto replica = out_.at(id).replica;
        for (auto& copy : places_[replica].copies)
            if (copy.id == id) copy.item = nullptr;
        refresh_tail(places_[replica], replica);
    }
    items_.erase(item.work.work);  // a copy of it may stand in a queue; it is skipped there
}

// ---- replicas come and go ----

void Scheduler::happens(const Joined& event, Time) {
    if (event.replica >= places_.size()) places_.resize(event.replica + 1);
    auto& place = places_[event.replica];
    assert(!place.present && "a replica joins once");
    place = Place{};
    place.present = true;
    place.host = event.host;
    place.name = event.name;
    place.process = event.process;
    place.credit = event.credit;
    place.patience = rules_.patience;
    sites_[event.host].replicas.insert(event.replica);
    ++present_;
    if (lost_.erase({event.host, event.process}) > 0) acquit(event.host, event.process);
    give_home(event.replica);
    refresh(event.replica);
}

void Scheduler::happens(const Draining& event, Time) {
    auto& place = places_.at(event.replica);
    if (!place.present || place.draining == event.draining) return;
    place.draining = event.draining;
    if (event.draining)
        take_home(event.replica);
    else
        give_home(event.replica);
    refresh(event.replica);
}

void Scheduler::happens(const Gone& event, Time) {
    std::map<Host, std::size_t> under_way;  // what each host had when it died: its places go together
    for (const auto replica : event.replicas) under_way[places_.at(replica).host] = 0;
    for (auto& [host, copies] : under_way)
        if (const auto site = sites_.find(host); site != sites_.end())
            copies = site->second.copies + site->second.strays;
    for (const auto replica : event.replicas)
        if (places_[replica].present) go(replica, event.died, under_way[places_[replica].host] == 1);
}

void Scheduler::go(Replica replica, bool died, bool alone) {
    auto& place = places_[replica];
    const auto copies = place.copies;
    for (const auto& copy : copies) take_copy(replica, copy.id);
    for (const auto stray : std::vector<CopyId>(place.strays)) {
        take_stray(out_.at(stray), stray);
        out_.erase(stray);
    }
    const Loss loss{place.host, place.process, alone};
    if (died && loss.process) lost_.insert({loss.host, loss.process});
    take_home(replica);
    place.present = false;
    --present_;
    auto& site = sites_.at(loss.host);
    site.replicas.erase(replica);
    if (site.replicas.empty()) {
        sites_.erase(loss.host);
        quarantined_.erase(loss.host);
    }
    refresh(replica);
    for (auto copy = copies.rbegin(); copy != copies.rend(); ++copy) {
        out_.erase(copy->id);
        if (!copy->item) continue;
        ++counts_.asked_again;
        std::erase(copy->item->copies, copy->id);
        if (died)
            blame(*copy->item, loss);
        else
            ask_again(*copy->item);
    }
}

void Scheduler::ask_again(Item& item) {
    if (item.copies.empty() && !item.waiting) wait_again(item);
}

void Scheduler::blame(Item& item, const Loss& loss) {
    item.losses.push_back(loss);
    std::vector<Host> alone;
    for (const auto& each : item.losses)
        if (each.alone) alone.push_back(each.host);
    if (alone.size() < static_cast<std::size_t>(rules_.deaths_alone)) return ask_again(item);
    actions_->push_back(SetAside{item.work.work, alone});
    finish(item);
}

void Scheduler::acquit(Host host, std::uint64_t process) {
    for (auto& [work, item] : items_)
        std::erase_if(item.losses, [&](const Loss& loss) { return loss.host == host && loss.process == process; });
    std::erase_if(suspects_, [&](WorkId work) {
        const auto item = items_.find(work);
        const bool clear = item != items_.end() && !item->second.suspect();
        if (clear && item->second.waiting) waiting_.push_front(work);
        return clear;
    });
}

// ---- copies come back ----

// Takes a copy off its replica's account.
Scheduler::Copy Scheduler::take_copy(Replica replica, CopyId id) {
    auto& place = places_[replica];
    const auto found =
        std::find_if(place.copies.begin(), place.copies.end(), [&](const Copy& copy) { return copy.id == id; });
    assert(found != place.copies.end() && "it is under way there");
    const Copy copy = *found;
    place.copies.erase(found);
    place.questions -= copy.questions;
    place.bytes -= copy.bytes;
    questions_out_ -= copy.questions;
    --copies_out_;
    --sites_.at(place.host).copies;
    return copy;
}

// Takes a copy that was written off from the books. Its work, if that is not done.
Scheduler::Item* Scheduler::take_stray(const Out& out, CopyId copy) {
    std::erase(places_[out.replica].strays, copy);
    --sites_.at(places_[out.replica].host).strays;
    const auto item = items_.find(out.work);
    if (item == items_.end()) return nullptr;
    std::erase(item->second.written_off, copy);
    return &item->second;
}

void Scheduler::happens(const Replied& event, Time now) {
    const auto found = out_.find(event.copy);
    if (found == out_.end()) return actions_->push_back(Drop{event.copy});
    const Out out = found->second;
    out_.erase(found);
    auto& place = places_[out.replica];
    Item* item = nullptr;
    if (out.written_off) {
        item = take_stray(out, event.copy);
    } else {
        const Copy copy = take_copy(out.replica, event.copy);
        if ((item = copy.item)) std::erase(item->copies, event.copy);
        measure(place, copy, event, now);
    }
    place.others = event.fill > place.questions ? event.fill - place.questions : 0;
    place.last_reply = now;
    place.silent = false;
    place.patience = rules_.patience;
    refresh(out.replica);
    if (!item) return actions_->push_back(Drop{event.copy});
    actions_->push_back(Accept{event.copy, out.work});
    finish(*item);
}

// A place that was never idle has spent on this copy what has passed since its last reply.
void Scheduler::measure(Place& place, const Copy& copy, const Replied& reply, Time now) {
    place.seconds = fading * place.seconds + std::max(now - std::max(copy.sent, place.last_reply), 0.0);
    place.answered = fading * place.answered + static_cast<double>(copy.questions);
    if (reply.service > 0) place.reported = reply.service;
}

void Scheduler::happens(const Failed& event, Time now) {
    const auto found = out_.find(event.copy);
    if (found == out_.end()) return actions_->push_back(Drop{event.copy});
    const Out out = found->second;
    out_.erase(found);
    Item* item = nullptr;
    if (out.written_off) {
        item = take_stray(out, event.copy);
    } else if ((item = take_copy(out.replica, event.copy).item)) {
        std::erase(item->copies, event.copy);
    }
    auto& place = places_[out.replica];
    place.last_reply = now;
    place.silent = false;
    refresh(out.replica);
    if (!item) return actions_->push_back(Drop{event.copy});
    item->failed_at.insert(place.host);
    ++item->failures;
    fail(*item);
}

void Scheduler::happens(const Refused& event, Time) {
    const auto found = out_.find(event.copy);
    if (found == out_.end()) return;
    const auto replica = found->second.replica;
    out_.erase(found);
    const Copy copy = take_copy(replica, event.copy);
    if (!places_[replica].refused) refused_.push_back(replica);
    places_[replica].refused = true;
    refresh(replica);
    if (!copy.item) return;
    std::erase(copy.item->copies, event.copy);
    ask_again(*copy.item);
}

// ---- time to decide ----

void Scheduler::happens(const Tick& event, Time now) {
    if (!event.again)
        for (const auto replica : std::exchange(refused_, {})) {
            places_[replica].refused = false;
            refresh(replica);
        }
    write_off_overdue(now);
    test_suspects(now);
    retry(now);
    hand_out(now);
    if (rules_.double_tail) double_tail(now);
}

void Scheduler::send(Item& item, Replica replica, Time now) {
    if (item.waiting) questions_waiting_ -= item.work.questions;
    item.waiting = false;
    auto& place = places_[replica];
    const bool known = rate_ > 0;
    const double seconds = completion_time(replica, item.work.questions);
    const double patience = known ? std::max(place.patience, rules_.late_factor * seconds)
                                  : std::max(place.patience, rules_.patience_at_first);
    const CopyId id = next_copy_++;
    out_.emplace(id, Out{replica, item.work.work});
    place.copies.push_back(
        {id, &item, item.work.questions, item.work.bytes, now, known ? now + seconds : Lowest::none, now + patience});
    place.questions += item.work.questions;
    place.bytes += item.work.bytes;
    place.turn = ++turn_;
    questions_out_ += item.work.questions;
    ++copies_out_;
    ++sites_.at(place.host).copies;
    item.copies.push_back(id);
    refresh(replica);
    for (const auto other : item.copies)
        if (other != id) refresh_tail(places_[out_.at(other).replica], out_.at(other).replica);
    actions_->push_back(Send{id, item.work.work, replica});
}

void Scheduler::hand_out(Time now) {
    while (!waiting_.empty()) {
        const auto found = items_.find(waiting_.front());
        if (found == items_.end() || !found->second.waiting) {
            waiting_.pop_front();
        } else if (found->second.suspect()) {
            suspects_.push_back(waiting_.front());
            waiting_.pop_front();
        } else {
            const auto replica = choose(found->second);
            if (!replica) return;
            waiting_.pop_front();
            send(found->second, *replica, now);
        }
    }
}

}  // namespace lightnet
