// Functions of Multiplexer; part of multiplexer.hpp.
#pragma once

#include "core/run/schedule/multiplexer.hpp"

namespace lightnet {

template <class Question>
void Multiplexer<Question>::use(std::vector<Channel<Question>*> channels,
                                const std::vector<Channel<Question>*>& draining) {
    const std::unordered_set<Channel<Question>*> wanted(channels.begin(), channels.end());
    const std::unordered_set<Channel<Question>*> leaving(draining.begin(), draining.end());
    std::unordered_set<Channel<Question>*> known;
    Scheduler::Gone died{{}, true}, left{{}, false};
    for (Scheduler::Replica replica = 0; replica < slots_.size(); ++replica) {
        auto& slot = slots_[replica];
        if (!slot.channel) continue;
        if (wanted.contains(slot.channel)) {
            known.insert(slot.channel);
        } else {
            (slot.draining ? left : died).replicas.push_back(replica);
        }
    }
    note_loss(died.replicas);
    for (const auto& gone : {left, died})
        if (!gone.replicas.empty()) tell(gone);
    for (const auto& gone : {left, died})
        for (const auto replica : gone.replicas) slots_[replica] = {}, free_slots_.push_back(replica);
    for (auto* channel : channels)
        if (known.insert(channel).second) add_replica(channel);
    for (Scheduler::Replica replica = 0; replica < slots_.size(); ++replica) {
        auto& slot = slots_[replica];
        if (!slot.channel) continue;
        if (const auto places = slot.channel->places(); places != slot.places) {
            slot.places = places;
            tell(Scheduler::Resized{replica, places, slot.channel->credit()});
        }
        if (slot.draining == leaving.contains(slot.channel)) continue;
        slot.draining = !slot.draining;
        tell(Scheduler::Draining{replica, slot.draining});
    }
}

template <class Question>
void Multiplexer<Question>::expect_hosts(bool more) {
    if (std::exchange(more_hosts_, more) != more) tell(Scheduler::HostsExpected{more});
}

template <class Question>
void Multiplexer<Question>::add_replica(Channel<Question>* channel) {
    if (free_slots_.empty()) {
        free_slots_.push_back(static_cast<Scheduler::Replica>(slots_.size()));
        slots_.emplace_back();
    }
    const auto replica = free_slots_.back();
    free_slots_.pop_back();
    const auto host_name = channel->host();
    const auto [host, is_new] = hosts_.emplace(host_name, static_cast<Scheduler::Host>(host_names_.size()));
    if (is_new) host_names_.push_back(host_name);
    slots_[replica] = {channel, false, host_name, channel->places(), channel->pulse(), channel->process()};
    tell(Scheduler::Joined{replica, host->second, channel->name() ? channel->name() : replica + 1, channel->credit(),
                           channel->process(), channel->places(), channel->reserve(), channel->within_process()});
    halve_what_was_lost_twice(host->second);
}

// Replicas that work at what they have are waited for, however long it takes.
template <class Question>
void Multiplexer<Question>::feel_pulses() {
    const double now = rules_.clock();
    if (now < next_pulse_) return;
    next_pulse_ = now + seconds_between_pulses;
    for (Scheduler::Replica replica = 0; replica < slots_.size(); ++replica) {
        auto& slot = slots_[replica];
        if (!slot.channel) continue;
        const auto pulse = slot.channel->pulse();
        if (std::exchange(slot.pulse, pulse) != pulse) tell(Scheduler::Alive{replica});
    }
}

// ---- the way there ----

template <class Question>
bool Multiplexer<Question>::send(const Bundle<Question>& bundle) {
    auto pieces = cut(*bundle.questions);
    if (pieces.size() <= 1) {
        add({bundle, nullptr, {}, {}});
    } else {
        if (counters_) counters_->cut_bundles += 1;
        const auto whole = whole_of(bundle);
        whole->missing = pieces.size();
        for (auto& where : pieces) add_piece(whole, std::move(where));
    }
    tick();
    return true;
}

template <class Question>
std::shared_ptr<typename Multiplexer<Question>::Whole> Multiplexer<Question>::whole_of(
    const Bundle<Question>& bundle) const {
    auto whole = std::make_shared<Whole>();
    whole->bundle = bundle;
    whole->answers.resize(answers_to(*bundle.questions, bundle.width));
    if constexpr (!std::is_same_v<Question, Query>) {
        std::size_t at = 0;
        for (const auto& question : *bundle.questions) {
            whole->at.push_back(at);
            at += answers_to(question, bundle.width);
        }
    }
    return whole;
}

template <class Question>
void Multiplexer<Question>::add_piece(const std::shared_ptr<Whole>& whole, std::vector<std::uint32_t> where) {
    auto questions = std::make_shared<std::vector<Question>>();
    questions->reserve(where.size());
    for (const auto index : where) questions->push_back((*whole->bundle.questions)[index]);
    const auto width = whole->bundle.width;
    add({{std::move(questions), nullptr, 0, width}, whole, std::move(where), {}});
}

template <class Question>
void Multiplexer<Question>::add(Entry entry, std::set<Scheduler::Host> not_at) {
    const auto& questions = *entry.bundle.questions;
    const auto bytes = questions.size() * sizeof(Question) + answers_to(questions, entry.bundle.width) * sizeof(Rgb);
    const Scheduler::Added added{next_work_, amount_of(questions), bytes, region_of(questions.front()),
                                 std::move(not_at)};
    if (!entry.check && rules_.checks.next()) entry.check = std::make_shared<Check>(Check{Votes(rules_.own), {}});
    entries_.emplace(next_work_++, std::move(entry));
    tell(added);
}

// Which questions go together: all, or as many pieces as there are idle replicas.
template <class Question>
std::vector<std::vector<std::uint32_t>> Multiplexer<Question>::cut(const std::vector<Question>& questions) const {
    if (!std::is_same_v<Question, Query> || questions.size() < 2 * rules_.least_piece || size() < 2) return {};
    if (rules_.scheduling.strategy == Strategy::affinity) return by_home(questions);
    const auto most = questions.size() / rules_.least_piece;
    const auto count = std::min(scheduler_.order().idle(), most);
    if (count < 2 || scheduler_.order().times().mean() * static_cast<double>(questions.size()) < rules_.worth_cutting)
        return {};
    std::vector<std::vector<std::uint32_t>> pieces(count);
    for (std::size_t piece = 0; piece < count; ++piece) {
        const auto first = questions.size() * piece / count, end = questions.size() * (piece + 1) / count;
        pieces[piece].resize(end - first);
        std::iota(pieces[piece].begin(), pieces[piece].end(), static_cast<std::uint32_t>(first));
    }
    return pieces;
}

// Each replica's regions; those with few questions go along with the largest.
template <class Question>
std::vector<std::vector<std::uint32_t>> Multiplexer<Question>::by_home(const std::vector<Question>& questions) const {
    std::map<Scheduler::Replica, std::vector<std::uint32_t>> homes;
    for (std::uint32_t i = 0; i < questions.size(); ++i)
        homes[scheduler_.replicas().home(region_of(questions[i]))].push_back(i);
    std::vector<std::vector<std::uint32_t>> pieces;
    std::vector<std::uint32_t> rest;
    for (auto& [replica, piece] : homes) {
        if (piece.size() >= rules_.least_piece / 2)
            pieces.push_back(std::move(piece));
        else
            rest.insert(rest.end(), piece.begin(), piece.end());
    }
    if (pieces.empty()) return {};
    auto& largest =
        *std::max_element(pieces.begin(), pieces.end(), [](auto& a, auto& b) { return a.size() < b.size(); });
    largest.insert(largest.end(), rest.begin(), rest.end());
    return pieces;
}

template <class Question>
bool Multiplexer<Question>::tick() {
    bool sent = false;
    feel_pulses();
    for (bool again = false;; again = true) {
        std::vector<Scheduler::Action> actions;
        scheduler_.on(Scheduler::Tick{again}, rules_.clock(), actions);
        const auto done = perform(actions);
        sent |= done.sent;
        if (!done.refused && !done.more) break;
    }
    count();
    return sent;
}

template <class Question>
typename Multiplexer<Question>::Performed Multiplexer<Question>::perform(
    const std::vector<Scheduler::Action>& actions) {
    Performed performed;
    settle(actions);
    for (const auto& action : actions) {
        const auto* send = std::get_if<Scheduler::Send>(&action);
        if (!send) continue;
        auto& entry = entries_.at(send->work);
        const Bundle<Question> copy{entry.bundle.questions, this, send->copy, entry.bundle.width};
        if (slots_[send->replica].channel->send(copy)) {
            if (rules_.differs) entry.copies.push_back(send->copy);
            performed.sent = true;
            performed.more |= ask_another(entry, send->replica);
        } else {
            tell(Scheduler::Refused{send->copy});
            performed.refused = true;
        }
    }
    return performed;
}

// ---- the way back ----

// Tells the scheduler what needs no answer but verdicts.
template <class Question>
void Multiplexer<Question>::tell(const Scheduler::Event& event) {
    std::vector<Scheduler::Action> actions;
    scheduler_.on(event, rules_.clock(), actions);
    settle(actions);
    if (std::holds_alternative<Scheduler::Dropped>(event)) let_dropped_go();
    count();
}

// Gives work back that nobody is asked for any more.
template <class Question>
void Multiplexer<Question>::settle(const std::vector<Scheduler::Action>& actions) {
    for (const auto& action : actions) {
        if (const auto* verdict = std::get_if<Scheduler::SetAside>(&action)) set_aside_work(*verdict);
        if (const auto* failed = std::get_if<Scheduler::GiveUp>(&action)) {
            Entry entry = std::move(entries_.extract(failed->work).mapped());
            const Failure failure = entry.failure;
            unheard(std::move(entry), failure, false);
        }
    }
}

template <class Question>
void Multiplexer<Question>::failed(const Bundle<Question>& bundle, const Failure& failure) {
    if (auto* const entry = entry_of(bundle.number)) entry->failure = failure;
    std::vector<Scheduler::Action> actions;
    scheduler_.on(Scheduler::Failed{bundle.number}, rules_.clock(), actions);
    expected_.erase(bundle.number);
    if (std::holds_alternative<Scheduler::Drop>(actions.front()) && counters_) ++counters_->late_replies;
    if (std::holds_alternative<Scheduler::Retry>(actions.front())) rules_.at_fault(failure);
    settle(actions);
    count();
}

// Null: its work is done.
template <class Question>
typename Multiplexer<Question>::Entry* Multiplexer<Question>::entry_of(Scheduler::CopyId copy) {
    const auto work = scheduler_.in_flight().work_of(copy);
    const auto entry = work ? entries_.find(*work) : entries_.end();
    return entry == entries_.end() ? nullptr : &entry->second;
}

template <class Question>
void Multiplexer<Question>::replied(const Bundle<Question>& bundle, Answers<Question> answers) {
    const auto replica = scheduler_.in_flight().replica_of(bundle.number);
    const Load load = replica && slots_[*replica].channel ? slots_[*replica].channel->load() : Load{};
    const auto host = replica ? slots_[*replica].host : std::string();
    const auto* const wanted = entry_of(bundle.number);
    if (const auto mistake = wanted ? mistake_in(wanted->bundle, answers, host) : std::string(); !mistake.empty())
        return failed(bundle, {mistake, host});
    const Scheduler::Replied reply{bundle.number, load.fill, load.service_ns * 1e-9, wanted ? shards_in(answers) : 0};
    std::vector<Scheduler::Action> actions;
    scheduler_.on(reply, rules_.clock(), actions);
    const auto* accept = std::get_if<Scheduler::Accept>(&actions.front());
    if (!accept) {
        if (counters_) ++counters_->late_replies;
        return compare(bundle.number, answers);
    }
    Entry entry = std::move(entries_.extract(accept->work).mapped());
    compare_later(entry, bundle.number, answers);
    if (entry.check) return heard(std::move(entry), host, std::move(answers));
    deliver(std::move(entry), std::move(answers));
}

template <class Question>
void Multiplexer<Question>::deliver(Entry entry, Answers<Question> answers) {
    if (!entry.whole) return entry.bundle.owner->answered(entry.bundle, std::move(answers));
    if constexpr (!std::is_same_v<Question, Step>) {  // which is never cut
        auto& whole = *entry.whole;
        auto from = answers.begin();
        for (const auto index : entry.where) {
            const auto count = answers_to((*whole.bundle.questions)[index], whole.bundle.width);
            const auto to = whole.at.empty() ? index * count : whole.at[index];
            std::copy_n(from, count, whole.answers.begin() + static_cast<std::ptrdiff_t>(to));
            from += static_cast<std::ptrdiff_t>(count);
        }
        if (--whole.missing == 0 && !whole.given_up)
            whole.bundle.owner->answered(whole.bundle, std::move(whole.answers));
    }
}

template <class Question>
void Multiplexer<Question>::give_up(const Entry& entry, const Failure& failure, bool set_aside) {
    if (entry.whole && std::exchange(entry.whole->given_up, true)) return;
    const auto& bundle = entry.whole ? entry.whole->bundle : entry.bundle;
    if (set_aside)
        bundle.owner->set_aside(bundle, failure.why);
    else
        bundle.owner->failed(bundle, {failure.why, rules_.names_host ? failure.host : std::string()});
}

template <class Question>
void Multiplexer<Question>::forget(const Bundle<Question>& bundle) {
    std::vector<Scheduler::WorkId> all;
    for (const auto& [work, entry] : entries_) {
        const auto& own = entry.whole ? entry.whole->bundle : entry.bundle;
        if (own.owner == bundle.owner && own.number == bundle.number) all.push_back(work);
    }
    for (const auto work : all) {
        tell(Scheduler::Forgotten{work});
        entries_.erase(work);
    }
}

template <class Question>
void Multiplexer<Question>::set_aside_work(const Scheduler::SetAside& verdict) {
    Entry entry = std::move(entries_.extract(verdict.work).mapped());
    std::string hosts;
    for (const auto host : verdict.died) hosts += (hosts.empty() ? "" : ", ") + host_names_[host];
    if (counters_) ++counters_->set_aside;
    const auto what = describe(*entry.bundle.questions);
    unheard(std::move(entry), {what + " is set aside: hosts died of it, with nothing else to do: " + hosts, {}}, true);
}

template <class Question>
std::chrono::nanoseconds Multiplexer<Question>::until_due() const {
    constexpr double longest = 0.1, shortest = 1e-3;
    const double left = scheduler_.refused() ? shortest : scheduler_.next_tick() - rules_.clock();
    return std::chrono::nanoseconds(static_cast<std::int64_t>(std::clamp(left, shortest, longest) * 1e9));
}

// ---- checking ----

template <class Question>
void Multiplexer<Question>::compare_later(const Entry& entry, Scheduler::CopyId first,
                                          const Answers<Question>& answers) {
    if (!rules_.differs || entry.copies.size() < 2) return;
    const auto hash = hash_of(answers);
    for (const auto copy : entry.copies)
        if (copy != first && expected_.size() < 100000) expected_[copy] = hash;  // some never come
}

template <class Question>
void Multiplexer<Question>::compare(Scheduler::CopyId copy, const Answers<Question>& answers) {
    const auto expected = expected_.extract(copy);
    if (expected.empty()) return;
    if (counters_) ++counters_->compared;
    if (hash_of(answers) != expected.mapped())
        rules_.differs("the same questions were answered twice, and differently");
}

// ---- as a channel, and for the books ----

template <class Question>
Credit Multiplexer<Question>::credit() const {
    Credit sum{0, 0, 0};
    for (const auto& slot : slots_) {
        if (!slot.channel) continue;
        const auto credit = slot.channel->credit();
        sum.bundles += credit.bundles, sum.questions += credit.questions, sum.bytes += credit.bytes;
    }
    return sum;
}

template <class Question>
Load Multiplexer<Question>::load() const {
    return {static_cast<std::uint32_t>(scheduler_.questions_ahead()),
            static_cast<std::uint32_t>(std::clamp(scheduler_.order().times().mean() * 1e9, 0.0, 4e9))};
}

template <class Question>
void Multiplexer<Question>::count() {
    if (!counters_) return;
    const auto& now = scheduler_.counts();
    counters_->asked_again += now.asked_again - counted_.asked_again;
    counters_->doubled += now.doubled - counted_.doubled;
    counters_->overdue += now.written_off - counted_.written_off;
    counters_->retried += now.retried - counted_.retried;
    counters_->spilled += now.spilled - counted_.spilled;
    counted_ = now;
}

}  // namespace lightnet
