#include "core/run/schedule/replica_order.hpp"

#include <algorithm>

namespace lightnet {
namespace {

constexpr double behind_all = 1e15;  // in any order of replicas

std::optional<ScheduleIds::Replica> first_of(const TournamentTree& tree) {
    return tree.any() ? std::optional(static_cast<ScheduleIds::Replica>(tree.first())) : std::nullopt;
}

}  // namespace

// ---- what a replica is worth ----

// What is ahead is shared by all places, and one of them does the new work.
double ReplicaOrder::completion_time(Replica replica, std::size_t questions) const {
    return (ahead(replica) + static_cast<double>(questions)) * times_.assumed(replica);
}

std::optional<double> ReplicaOrder::soonest(std::size_t questions) const {
    const auto first = first_open();
    if (!first || at_.book[*first].reserve) return std::nullopt;
    return completion_time(*first, questions);
}

bool ReplicaOrder::has_idle_place(Replica replica) const {
    return at_.in_flight.of(replica).copies.size() < at_.book[replica].places;
}

// Questions of each of its places.
double ReplicaOrder::ahead(Replica replica) const {
    const auto& state = at_.book[replica];
    return static_cast<double>(at_.in_flight.of(replica).questions + state.others) / static_cast<double>(state.places);
}

bool ReplicaOrder::is_open(Replica replica) const {
    const auto& state = at_.book[replica];
    const auto& account = at_.in_flight.of(replica);
    if (!state.present || state.draining || state.refused || at_.suspects.in_quarantine(state.host)) return false;
    if (account.copies.empty()) return true;
    return !state.silent && account.copies.size() < state.credit.bundles &&
           account.questions < state.credit.questions && account.bytes < state.credit.bytes;
}

double ReplicaOrder::key(Replica replica) const {
    const auto& state = at_.book[replica];
    if (state.reserve) return behind_all;
    const double service = times_.of(replica);
    return (ahead(replica) + usual_) * (service > 0 ? service : ServiceTimes::unknown);
}

// ---- keeping the order ----

void ReplicaOrder::refresh(Replica replica) {
    const auto& state = at_.book[replica];
    const bool open = is_open(replica);
    open_.set(replica, open ? key(replica) : TournamentTree::none);
    const bool idle = open && !state.reserve && has_idle_place(replica);
    idle_.set(replica, idle ? key(replica) : TournamentTree::none);
    if (replica >= counted_idle_.size()) counted_idle_.resize(replica + 1);
    idle_count_ = idle_count_ + idle - counted_idle_[replica];
    counted_idle_[replica] = idle;

    const bool works =
        state.present && !state.draining && !state.silent && !state.refused && !at_.suspects.in_quarantine(state.host);
    times_.take_part(replica, works ? state.places : 0);
    // Nothing waits for the reserve, which is asked when the others can't be: it may be the fastest of all.
    const bool known = works && !state.reserve && times_.of(replica) > 0;
    all_.set(replica, known ? (ahead(replica) + usual_) * times_.assumed(replica) : TournamentTree::none);
}

// Replicas are in order by when they would finish usual work. Were that larger than it is, a replica that only seems a
// little faster would get far more than its part.
// DECISIONS: compared-by-usual-work
bool ReplicaOrder::note_size(std::size_t questions) {
    constexpr double lately = 0.05, much = 1.5;
    const auto size = static_cast<double>(questions);
    mean_size_ = usual_ > 0 ? mean_size_ + lately * (size - mean_size_) : size;
    if (mean_size_ <= much * usual_ && usual_ <= much * mean_size_) return false;
    usual_ = mean_size_;
    return true;
}

// ---- who comes first ----

std::optional<ReplicaOrder::Replica> ReplicaOrder::first_open() const { return first_of(open_); }
std::optional<ReplicaOrder::Replica> ReplicaOrder::quickest() const { return first_of(all_); }

ReplicaOrder::Replica ReplicaOrder::first_open_but(std::span<const Replica> holders) {
    const auto first = first_open().value();
    for (const auto holder : holders) open_.set(holder, TournamentTree::none);
    const auto other = first_open();
    for (const auto holder : holders) refresh(holder);
    return other.value_or(first);
}

std::optional<ReplicaOrder::Replica> ReplicaOrder::first_idle() const {
    if (const auto idle = first_of(idle_)) return idle;
    const auto reserve = at_.book.reserve();
    return reserve && is_open(*reserve) && has_idle_place(*reserve) ? reserve : std::nullopt;
}

std::optional<ReplicaOrder::Replica> ReplicaOrder::first_idle_but(std::span<const Replica> holders) {
    for (const auto holder : holders) idle_.set(holder, TournamentTree::none);
    auto idle = first_idle();
    if (idle && std::ranges::find(holders, *idle) != holders.end()) idle.reset();  // the reserve
    for (const auto holder : holders) refresh(holder);
    return idle;
}

// Within the asker's process nobody wins by doing what another does: both have the same machine.
std::optional<ReplicaOrder::Replica> ReplicaOrder::first_idle_elsewhere() const {
    std::optional<Replica> idle;
    for (Replica replica = 0; replica < at_.book.end(); ++replica)
        if (!at_.book[replica].within_process && idle_.key(replica) < TournamentTree::none &&
            (!idle || idle_.key(replica) < idle_.key(*idle)))
            idle = replica;
    return idle;
}

}  // namespace lightnet
