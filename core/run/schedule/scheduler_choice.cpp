// How the scheduler chooses: what replicas are worth, and in which order they stand.
#include <algorithm>
#include <utility>

#include "core/base/math/random.hpp"
#include "core/run/schedule/scheduler.hpp"

namespace lightnet {
namespace {

constexpr double unknown_service = 1e-6;  // a new replica looks fast, so that it gets work, and is measured
constexpr std::uint64_t points_per_replica = 32;
constexpr double overloaded = 4;  // times the completion of the best: then work leaves its home

}  // namespace

// ---- what a replica is worth ----

/// Seconds per question; 0: not known. What the asker sees of it, with all waiting of its own, or what it says of
/// itself, whichever is more.
double Scheduler::service_of(const Place& place) const {
    return place.answered > 0 ? std::max(place.seconds / place.answered, place.reported) : place.reported;
}

double Scheduler::completion_time(Replica replica, std::size_t questions) const {
    const auto& place = places_[replica];
    double service = service_of(place);
    if (service == 0) service = rate_ > 0 ? static_cast<double>(measured_) / rate_ : unknown_service;
    return static_cast<double>(place.questions + place.others + questions) * service;
}

bool Scheduler::open(const Place& place) const {
    if (!place.present || place.draining || place.refused || quarantined_.contains(place.host)) return false;
    if (place.copies.empty()) return true;
    return !place.silent && place.copies.size() < place.credit.bundles && place.questions < place.credit.questions &&
           place.bytes < place.credit.bytes;
}

double Scheduler::order(const Place& place) const {
    const auto ahead = static_cast<double>(place.questions + place.others);
    switch (rules_.strategy) {
        case Strategy::round_robin:
            return static_cast<double>(place.turn);
        case Strategy::least_loaded:
            return ahead;
        default: {
            const double service = service_of(place);
            return (ahead + static_cast<double>(rules_.usual)) * (service > 0 ? service : unknown_service);
        }
    }
}

// ---- keeping the order ----

void Scheduler::refresh(Replica replica) {
    auto& place = places_[replica];
    const bool is_open = open(place);
    open_.set(replica, is_open ? order(place) : Lowest::none);
    const bool idle = is_open && place.copies.empty();
    idle_ = idle_ + idle - std::exchange(place.counted_idle, idle);

    const bool works =
        place.present && !place.draining && !place.silent && !place.refused && !quarantined_.contains(place.host);
    const double service = works ? service_of(place) : 0;
    const double rate = service > 0 ? 1 / service : 0;
    measured_ = measured_ + (rate > 0) - (place.counted_rate > 0);
    rate_ = measured_ > 0 ? rate_ + rate - place.counted_rate : 0;
    place.counted_rate = rate;
    all_.set(replica, rate > 0 ? completion_time(replica, rules_.usual) : Lowest::none);
    refresh_tail(place, replica);
}

void Scheduler::refresh_tail(Place& place, Replica replica) {
    double overdue = Lowest::none, early = Lowest::none, late = -Lowest::none;
    for (const auto& copy : place.copies) {
        overdue = std::min(overdue, copy.overdue);
        if (!may_be_doubled(copy)) continue;
        early = std::min(early, copy.expected);
        late = std::max(late, copy.expected);
    }
    overdue_.set(replica, overdue);
    if (!rules_.double_tail) return;
    early_.set(replica, early);
    late_.set(replica, -late);
}

// ---- choosing ----

std::optional<Scheduler::Replica> Scheduler::choose(const Item& item) {
    if (!open_.any()) return std::nullopt;
    const auto best = best_for(item);
    if (rules_.strategy == Strategy::affinity && !ring_.empty()) {
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
        for (const auto copy : *copies) holders.push_back(out_.at(copy).replica);
    for (const auto holder : holders) open_.set(holder, Lowest::none);
    if (open_.any()) best = static_cast<Replica>(open_.first());
    for (const auto holder : holders) refresh(holder);
    return best;
}

// A slow replica gets nothing that the others together would have answered sooner without it.
// DECISIONS: nothing-for-the-slowest
bool Scheduler::better_held_back(const Item& item, Replica replica) const {
    if (!item.written_off.empty()) return false;  // the fast ones have had their chance
    if (service_of(places_[replica]) == 0 || !all_.any() || all_.first() == replica) return false;
    const auto left = static_cast<double>(questions_out_ + questions_waiting_ + foreseen_);
    const auto questions = item.work.questions;
    const double sooner = completion_time(static_cast<Replica>(all_.first()), questions);
    return completion_time(replica, questions) > std::max(left / rate_, sooner);
}

bool Scheduler::may_be_doubled(const Copy& copy) const {
    return copy.item && !copy.item->suspect() && copy.item->copies.size() == 1 && copy.expected < Lowest::none;
}

// What `idle` could do: a copy that is late by half of its time, else the one that is expected last, if that is later
// than `idle` would need.
const Scheduler::Copy* Scheduler::worth_doubling(Replica idle, Time now) const {
    const auto find = [&](Replica replica, double expected) -> const Copy* {
        for (const auto& copy : places_[replica].copies)
            if (may_be_doubled(copy) && copy.expected == expected && !copy.item->failed_at.contains(places_[idle].host))
                return &copy;
        return nullptr;
    };
    if (!early_.any()) return nullptr;
    const Copy* first = find(static_cast<Replica>(early_.first()), early_.least());
    if (first && now > first->expected + 0.5 * (first->expected - first->sent)) return first;
    const Copy* last = find(static_cast<Replica>(late_.first()), -late_.least());
    return last && now + 1.1 * completion_time(idle, last->questions) < last->expected ? last : nullptr;
}

// ---- affinity ----

// Points of a circle belong to replicas, and a region to the next point: when a replica goes, only its own regions move
// (Karger et al. 1997).
void Scheduler::give_home(Replica replica) {
    for (std::uint64_t i = 0; i < points_per_replica; ++i) ring_.emplace(child(places_[replica].name, 0, i), replica);
}

void Scheduler::take_home(Replica replica) {
    for (std::uint64_t i = 0; i < points_per_replica; ++i) {
        const auto point = ring_.find(child(places_[replica].name, 0, i));
        if (point != ring_.end() && point->second == replica) ring_.erase(point);
    }
}

Scheduler::Replica Scheduler::home(std::uint64_t region) const {
    const auto next = ring_.lower_bound(mix(region + 1));
    return (next == ring_.end() ? ring_.begin() : next)->second;
}

}  // namespace lightnet
