// The scheduler's choice among replicas: what they are worth, and in which order they stand.
#include <algorithm>
#include <utility>

#include "core/run/schedule/scheduler.hpp"

namespace lightnet {
namespace {

constexpr double overloaded = 4;     // times the completion of the best: then work leaves its home
constexpr double behind_all = 1e15;  // in any order of replicas

}  // namespace

// ---- what a replica is worth ----

// What is ahead is shared by all places, and one of them does the new work.
double Scheduler::completion_time(Replica replica, std::size_t questions) const {
    return (ahead(replica) + static_cast<double>(questions)) * times_.assumed(replica);
}

std::optional<double> Scheduler::soonest(std::size_t questions) const {
    if (!open_.any()) return std::nullopt;
    const auto replica = static_cast<Replica>(open_.first());
    if (replicas_[replica].reserve) return std::nullopt;
    return completion_time(replica, questions);
}

bool Scheduler::has_idle_place(Replica replica) const {
    return in_flight_.of(replica).copies.size() < replicas_[replica].places;
}

// Questions of each of its places.
double Scheduler::ahead(Replica replica) const {
    const auto& state = replicas_[replica];
    return static_cast<double>(in_flight_.of(replica).questions + state.others) / static_cast<double>(state.places);
}

std::size_t Scheduler::questions_ahead() const {
    std::size_t questions = in_flight_.questions() + questions_waiting_;
    for (const auto& replica : replicas_) questions += replica.present ? replica.others : 0;
    return questions;
}

bool Scheduler::open(Replica replica) const {
    const auto& state = replicas_[replica];
    const auto& account = in_flight_.of(replica);
    if (!state.present || state.draining || state.refused || suspects_.in_quarantine(state.host)) return false;
    if (account.copies.empty()) return true;
    return !state.silent && account.copies.size() < state.credit.bundles &&
           account.questions < state.credit.questions && account.bytes < state.credit.bytes;
}

double Scheduler::order(Replica replica) const {
    if (replicas_[replica].reserve) return behind_all;
    switch (rules_.strategy) {
        case Strategy::round_robin:
            return static_cast<double>(replicas_[replica].turn);
        case Strategy::least_loaded:
            return ahead(replica);
        default: {
            const double service = times_.of(replica);
            return (ahead(replica) + usual_) * (service > 0 ? service : ServiceTimes::unknown);
        }
    }
}

// ---- keeping the order ----

void Scheduler::refresh(Replica replica) {
    auto& state = replicas_[replica];
    const bool is_open = open(replica);
    open_.set(replica, is_open ? order(replica) : TournamentTree::none);
    const bool idle = is_open && !state.reserve && has_idle_place(replica);
    idle_.set(replica, idle ? order(replica) : TournamentTree::none);
    idle_count_ = idle_count_ + idle - std::exchange(state.counted_idle, idle);

    const bool works =
        state.present && !state.draining && !state.silent && !state.refused && !suspects_.in_quarantine(state.host);
    times_.take_part(replica, works ? state.places : 0);
    // Nothing waits for the reserve, which is asked when the others can't be: it may be the fastest of all.
    const bool known = works && !state.reserve && times_.of(replica) > 0;
    all_.set(replica, known ? (ahead(replica) + usual_) * times_.assumed(replica) : TournamentTree::none);
    refresh_due(replica);
}

// Replicas are in order by when they would finish usual work. Were that larger than it is, a replica that only seems a
// little faster would get far more than its part.
// DECISIONS: compared-by-usual-work
void Scheduler::note_size(std::size_t questions) {
    constexpr double lately = 0.05, much = 1.5;
    const auto size = static_cast<double>(questions);
    mean_size_ = usual_ > 0 ? mean_size_ + lately * (size - mean_size_) : size;
    if (mean_size_ <= much * usual_ && usual_ <= much * mean_size_) return;
    usual_ = mean_size_;
    for (Replica replica = 0; replica < replicas_.size(); ++replica) refresh(replica);
}

void Scheduler::refresh_due(Replica replica) {
    Stragglers::Due due;
    for (const auto& copy : in_flight_.of(replica).copies) {
        due.overdue = std::min(due.overdue, copy.overdue);
        if (!rules_.double_tail || !may_be_doubled(copy)) continue;
        if (replicas_[replica].within_process && elsewhere_ == 0) continue;
        due.late = std::min(due.late, copy.late);
        if (copy.expected < TournamentTree::none) due.last = std::max(due.last, copy.expected);
    }
    stragglers_.set(replica, due);
}

// ---- choosing ----

std::optional<Scheduler::Replica> Scheduler::choose(const Item& item) {
    if (!open_.any()) return std::nullopt;
    auto best = best_for(item);
    if (rules_.last_to_idle && waits_for_idle(item, best)) {
        if (!idle_.any()) return std::nullopt;
        best = static_cast<Replica>(idle_.first());
    }
    if (rules_.strategy == Strategy::affinity && !homes_.empty()) {
        const auto at_home = home(item.work.region);
        const auto questions = item.work.questions;
        if (at_home == best) return best;
        if (open_.key(at_home) < TournamentTree::none && item.written_off.empty() &&
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
        for (const auto copy : *copies) holders.push_back(*in_flight_.replica_of(copy));
    for (const auto holder : holders) open_.set(holder, TournamentTree::none);
    if (open_.any()) best = static_cast<Replica>(open_.first());
    for (const auto holder : holders) refresh(holder);
    return best;
}

// A slow replica gets nothing that the others together would have answered sooner without it.
// DECISIONS: nothing-for-the-slowest
bool Scheduler::better_held_back(const Item& item, Replica replica) const {
    if (!item.written_off.empty()) return false;  // the fast ones have had their chance
    if (times_.of(replica) == 0 || !all_.any() || all_.first() == replica) return false;
    const auto left = static_cast<double>(questions_wanted_ + foreseen_);
    const auto questions = item.work.questions;
    const double sooner = completion_time(static_cast<Replica>(all_.first()), questions);
    return completion_time(replica, questions) > std::max(left / times_.rate(), sooner);
}

// Behind other work, the last of a phase would keep all waiting: it is better off with who is idle next.
// DECISIONS: last-to-idle
bool Scheduler::waits_for_idle(const Item& item, Replica replica) const {
    if (rules_.strategy == Strategy::affinity || !item.written_off.empty() || has_idle_place(replica)) return false;
    if (questions_waiting_ + foreseen_ > places_) return false;
    return !times_.any() || completion_time(replica, 0) > rules_.worth;
}

// ---- speculative execution ----

bool Scheduler::may_be_doubled(const InFlight::Copy& copy) const {
    const auto found = items_.find(copy.work);
    return found != items_.end() && found->second.work.not_at.empty() && !suspects_.is_suspect(copy.work) &&
           found->second.copies.size() == 1;
}

bool Scheduler::may_be_afforded(std::size_t questions, double saves) const {
    const auto doubled = static_cast<double>(questions_doubled_ + questions);
    return doubled <= rules_.tail_part * static_cast<double>(questions_added_) ||
           (counts_.doubled < rules_.tail_least && saves >= rules_.tail_saves);
}

// Seconds, as far as can be foreseen: who is late already may be so for as long again.
double Scheduler::saved_by(Replica idle, const InFlight::Copy& copy, Time now) const {
    if (copy.late <= now) return now - copy.late;
    return copy.expected - now - completion_time(idle, copy.questions);
}

// What `idle` could do: a copy that is late, if `idle` takes no longer than it was to take; else the one that is
// expected last, if `idle` would win more time than it spends.
const InFlight::Copy* Scheduler::worth_doubling(Replica idle, Time now) const {
    const auto find = [&](Replica replica, const auto& is_meant) -> const InFlight::Copy* {
        if (replicas_[replica].within_process && replicas_[idle].within_process) return nullptr;
        for (const auto& copy : in_flight_.of(replica).copies)
            if (may_be_doubled(copy) && is_meant(copy) &&
                !items_.at(copy.work).failed_at.contains(replicas_[idle].host))
                return &copy;
        return nullptr;
    };
    const auto needs = [&](const InFlight::Copy& copy) { return completion_time(idle, copy.questions); };
    if (const Time late = stragglers_.late(); late <= now)
        if (const auto* copy = find(stragglers_.late_at(), [&](const auto& one) { return one.late == late; });
            copy && needs(*copy) <= copy->expected - copy->sent)
            return copy;
    const Time last = stragglers_.last();
    if (times_.of(idle) == 0 || last == -TournamentTree::none) return nullptr;
    const auto* copy = find(stragglers_.last_at(), [&](const auto& one) { return one.expected == last; });
    return copy && now + 2 * needs(*copy) + rules_.worth < last ? copy : nullptr;
}

// Who could do something once more; the reserve comes last.
std::optional<Scheduler::Replica> Scheduler::idle_one() const {
    if (idle_.any()) return static_cast<Replica>(idle_.first());
    return reserve_ && open(*reserve_) && has_idle_place(*reserve_) ? reserve_ : std::nullopt;
}

// Within the asker's process nobody wins by doing what another does: both have the same machine.
std::optional<Scheduler::Replica> Scheduler::idle_elsewhere() const {
    std::optional<Replica> idle;
    for (Replica replica = 0; replica < replicas_.size(); ++replica)
        if (!replicas_[replica].within_process && idle_.key(replica) < TournamentTree::none &&
            (!idle || idle_.key(replica) < idle_.key(*idle)))
            idle = replica;
    return idle;
}

// When work runs out, idle replicas do once more what will otherwise come last.
void Scheduler::double_tail(Time now) {
    while (is_tail()) {
        auto idle = idle_one();
        const auto* copy = idle ? worth_doubling(*idle, now) : nullptr;
        if (!copy && idle && replicas_[*idle].within_process) {
            idle = idle_elsewhere();
            copy = idle ? worth_doubling(*idle, now) : nullptr;
        }
        if (!copy || !may_be_afforded(copy->questions, saved_by(*idle, *copy, now))) return;
        ++counts_.doubled;
        questions_doubled_ += copy->questions;
        send(items_.at(copy->work), *idle, now);
    }
}

}  // namespace lightnet
