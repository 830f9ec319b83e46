#include "core/run/schedule/replica_book.hpp"

#include <cassert>

namespace lightnet {

void ReplicaBook::join(const ScheduleTerms::Joined& event, double patience) {
    if (event.replica >= states_.size()) states_.resize(event.replica + 1);
    auto& state = states_[event.replica];
    assert(!state.present && "a replica joins once");
    state = {};
    state.present = true;
    state.host = event.host;
    state.name = event.name;
    state.process = event.process;
    state.credit = event.credit;
    state.places = event.places;
    state.reserve = event.reserve;
    state.within_process = event.within_process;
    state.patience = patience;
    if (event.reserve) reserve_ = event.replica;
    hosts_[event.host].insert(event.replica);
    ++present_;
    places_ += event.places;
    elsewhere_ += !event.within_process;
    give_home(event.replica);
}

// Regions belong to it from now on: where they count.
void ReplicaBook::give_home(Replica replica) {
    const auto& state = states_[replica];
    if (with_homes_ && !state.reserve) homes_.add(replica, state.name, state.places);
}

void ReplicaBook::resize(const ScheduleTerms::Resized& event) {
    auto& state = states_.at(event.replica);
    if (!state.present) return;
    homes_.remove(event.replica, state.name, state.places);
    places_ = places_ - state.places + event.places;
    state.places = event.places;
    state.credit = event.credit;
    if (!state.draining) give_home(event.replica);
}

void ReplicaBook::drain(const ScheduleTerms::Draining& event) {
    auto& state = states_.at(event.replica);
    if (!state.present || state.draining == event.draining) return;
    state.draining = event.draining;
    if (event.draining)
        homes_.remove(event.replica, state.name, state.places);
    else
        give_home(event.replica);
}

bool ReplicaBook::leave(Replica replica) {
    auto& state = states_.at(replica);
    homes_.remove(replica, state.name, state.places);
    state.present = false;
    if (state.reserve) reserve_.reset();
    --present_;
    places_ -= state.places;
    elsewhere_ -= !state.within_process;
    const auto host = hosts_.find(state.host);
    host->second.erase(replica);
    if (!host->second.empty()) return false;
    hosts_.erase(host);
    return true;
}

}  // namespace lightnet
