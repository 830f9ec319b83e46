#include "core/run/master/shard_dealer.hpp"

#include <algorithm>
#include <utility>

#include "core/run/schedule/guided.hpp"

namespace lightnet {
namespace {

constexpr Credit credit_of_each{2, ~std::size_t{0}, ~std::size_t{0}};  // an ask to work at, and one that waits
constexpr std::size_t shares_of_a_copy = 3;                            // for each copy, see guided_share()
constexpr int bits_of_a_copy = 40;

Scheduler::Rules rules_of_shards() {
    Scheduler::Rules rules;
    rules.last_to_idle = true;
    rules.double_tail = true;
    rules.tail_part = 1;  // nobody has anything else to do
    return rules;
}

}  // namespace

ShardDealer::ShardDealer() : scheduler_(rules_of_shards()) {}

void ShardDealer::begin(std::uint32_t count) {
    const auto round = rounds_ + 1;
    *this = ShardDealer();
    rounds_ = round;
    for (std::uint32_t shard = 0; shard < count; ++shard) to_do_.push_back(shard);
}

ShardDealer::Actions ShardDealer::tell(const Scheduler::Event& event, Time now) {
    Actions actions;
    scheduler_.on(event, now, actions);
    for (const auto& action : actions) {
        if (const auto* verdict = std::get_if<Scheduler::SetAside>(&action)) set_aside(*verdict);
        if (const auto* hopeless = std::get_if<Scheduler::GiveUp>(&action)) give_up(hopeless->work);
    }
    return actions;
}

// Nobody else has joined so far.
void ShardDealer::give_up(Scheduler::WorkId work) {
    const Shards shards = works_.extract(work).mapped();
    if (also_.erase(work))
        unasked_.push_back(shards.first);
    else
        put_back(shards);
}

void ShardDealer::add(const Shards& shards, std::set<Scheduler::Host> not_at, Time now) {
    works_.emplace(next_work_, shards);
    if (!not_at.empty()) also_.insert(next_work_);
    tell(Scheduler::Added{.work = next_work_++, .questions = shards.count, .not_at = std::move(not_at)}, now);
}

void ShardDealer::ask_also(std::uint32_t shard, const std::vector<std::string>& hosts, Time now) {
    std::set<Scheduler::Host> not_at;
    for (const auto& host : hosts)
        not_at.insert(static_cast<Scheduler::Host>(std::find(hosts_.begin(), hosts_.end(), host) - hosts_.begin()));
    add({shard, 1}, std::move(not_at), now);
}

// ---- who does them ----

bool ShardDealer::join(const NodeCopy& copy, std::uint64_t process, Time now) {
    if (const auto known = joined_.find(copy); known != joined_.end()) {
        if (draining_.erase(copy)) tell(Scheduler::Draining{known->second, false}, now);
        return false;
    }
    const auto replica = static_cast<Scheduler::Replica>(copies_.size());
    copies_.push_back(copy);
    joined_.emplace(copy, replica);
    auto host = std::find(hosts_.begin(), hosts_.end(), copy.place.host);
    if (host == hosts_.end()) host = hosts_.insert(host, copy.place.host);
    tell(Scheduler::Joined{replica, static_cast<Scheduler::Host>(host - hosts_.begin()), replica + 1, credit_of_each,
                           process, 1, false, copy.place.host.empty()},
         now);
    return true;
}

void ShardDealer::keep(const Plan& plan, const std::set<NodeCopy>& there, Time now) {
    const std::set<PlaceAt> places(plan.places.begin(), plan.places.end());
    Scheduler::Gone died{{}, true}, left{{}, false};
    for (auto entry = joined_.begin(); entry != joined_.end();) {
        const auto& [copy, replica] = *entry;
        const bool stays = there.contains(copy);
        if (places.contains(copy.place)) {
            if (!stays && draining_.insert(copy).second) tell(Scheduler::Draining{replica, true}, now);
            if (stays && draining_.erase(copy)) tell(Scheduler::Draining{replica, false}, now);
            ++entry;
            continue;
        }
        (draining_.erase(copy) ? left : died).replicas.push_back(replica);
        entry = joined_.erase(entry);
    }
    for (const auto& gone : {left, died})
        if (!gone.replicas.empty()) tell(gone, now);
}

// ---- the way there ----

std::vector<ShardDealer::Deal> ShardDealer::deal(std::size_t copies, Time now) {
    std::vector<Deal> deals;
    for (bool more = true; more;) {
        more = (!to_do_.empty() || !alone_.empty()) && scheduler_.has_room();
        if (more) {
            add(take_next(copies), {}, now);
        }
        tell(Scheduler::Foreseen{to_do_.size() + alone_.size()}, now);
        for (const auto& action : tell(Scheduler::Tick{}, now))
            if (const auto* send = std::get_if<Scheduler::Send>(&action))
                deals.push_back(
                    {rounds_ << bits_of_a_copy | send->copy, copies_[send->replica], works_.at(send->work)});
    }
    return deals;
}

Shards ShardDealer::take_next(std::size_t copies) {
    if (!alone_.empty()) {
        const Shards some{alone_.back(), 1};
        alone_.pop_back();
        return some;
    }
    const auto most =
        std::max<std::size_t>(1, guided_share(to_do_.size(), std::max<std::size_t>(1, copies), shares_of_a_copy));
    Shards some{to_do_.front(), 0};
    while (!to_do_.empty() && to_do_.front() == some.first + some.count && some.count < most) {
        to_do_.pop_front();
        ++some.count;
    }
    return some;
}

void ShardDealer::put_back(const Shards& shards) {
    for (auto shard = shards.first + shards.count; shard-- > shards.first;) to_do_.push_front(shard);
}

void ShardDealer::feel_pulses(const std::function<std::uint64_t(const std::string&)>& pulse, Time now) {
    if (now < next_pulse_) return;
    next_pulse_ = now + seconds_between_pulses;
    std::set<std::string> alive;
    for (const auto& host : hosts_) {
        const auto felt = pulse(host);
        if (std::exchange(pulses_[host], felt) != felt) alive.insert(host);
    }
    for (const auto& [copy, replica] : joined_)
        if (alive.contains(copy.place.host)) tell(Scheduler::Alive{replica}, now);
}

void ShardDealer::refused(CopyId id, Time now) {
    if (const auto copy = known(id)) tell(Scheduler::Refused{*copy}, now);
}

// ---- the way back ----

std::optional<Scheduler::CopyId> ShardDealer::known(CopyId id) const {
    const Scheduler::CopyId copy = id & ((CopyId{1} << bits_of_a_copy) - 1);
    return id >> bits_of_a_copy == rounds_ && scheduler_.in_flight().work_of(copy) ? std::optional(copy) : std::nullopt;
}

std::optional<Shards> ShardDealer::shards_of(CopyId id) const {
    const auto copy = known(id);
    const auto work = copy ? works_.find(*scheduler_.in_flight().work_of(*copy)) : works_.end();
    return work == works_.end() ? std::nullopt : std::optional(work->second);
}

bool ShardDealer::is_asked_also(CopyId id) const {
    const auto copy = known(id);
    return copy && also_.contains(*scheduler_.in_flight().work_of(*copy));
}

std::optional<std::string> ShardDealer::host_of(CopyId id) const {
    const auto copy = known(id);
    const auto replica = copy ? scheduler_.in_flight().replica_of(*copy) : std::nullopt;
    return replica ? std::optional(copies_[*replica].place.host) : std::nullopt;
}

bool ShardDealer::answered(CopyId id, std::uint32_t done, Time now) {
    const auto copy = known(id);
    if (!copy) return false;
    for (const auto& action : tell(Scheduler::Replied{.copy = *copy, .answered = done}, now))
        if (const auto* accept = std::get_if<Scheduler::Accept>(&action)) {
            const Shards shards = works_.extract(accept->work).mapped();
            if (also_.erase(accept->work)) return true;
            put_back({shards.first + done, shards.count - done});
            return true;
        }
    return false;
}

bool ShardDealer::failed(CopyId id, Time now) {
    const auto copy = known(id);
    if (!copy) return false;
    const auto actions = tell(Scheduler::Failed{*copy}, now);
    return std::none_of(actions.begin(), actions.end(),
                        [](const auto& action) { return std::holds_alternative<Scheduler::Drop>(action); });
}

// Of several, one may be to blame: each is tried alone.
void ShardDealer::set_aside(const Scheduler::SetAside& verdict) {
    const Shards shards = works_.extract(verdict.work).mapped();
    if (also_.erase(verdict.work)) return unasked_.push_back(shards.first);
    if (shards.count > 1) {
        for (auto shard = shards.first + shards.count; shard-- > shards.first;) alone_.push_back(shard);
        return;
    }
    convicted_ = Convicted{shards.first, {}};
    for (const auto host : verdict.died) convicted_->hosts.push_back(hosts_[host]);
}

}  // namespace lightnet
