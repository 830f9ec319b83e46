// Verified work of a Multiplexer: done by two hosts, and compared; part of multiplexer.hpp.
#pragma once

#include "core/run/schedule/multiplexer.hpp"

namespace lightnet {

// When the first host is known, another is asked: both at the same time, so that checked work takes hardly longer. To
// either it is a question like all others.
template <class Question>
bool Multiplexer<Question>::ask_another(Entry& entry, Scheduler::Replica asked) {
    if (!entry.check || std::exchange(entry.check->begun, true)) return false;
    const auto& host = slots_[asked].host;
    if (host == rules_.own) {
        entry.check = nullptr;
        return false;
    }
    ++entry.check->asked;
    add({entry.bundle, entry.whole, entry.where, {}, {}, entry.check}, {hosts_.at(host)});
    return true;
}

template <class Question>
void Multiplexer<Question>::heard(Entry entry, const std::string& host, Answers<Question> answers) {
    auto& check = *entry.check;
    const auto hash = hash_of(answers);
    check.votes.add(host, hash);
    const bool known =
        std::any_of(check.answers.begin(), check.answers.end(), [&](const auto& one) { return one.first == hash; });
    if (!known) check.answers.emplace_back(hash, std::move(answers));
    weigh(std::move(entry));
}

// It failed, or nobody else is there who could be asked.
template <class Question>
void Multiplexer<Question>::unheard(Entry entry, const Failure& failure, bool set_aside) {
    if (!entry.check) return give_up(entry, failure, set_aside);
    auto& check = *entry.check;
    if (--check.asked > 0) return;
    if (check.votes.empty()) return give_up(entry, failure, set_aside);
    const bool agree = check.answers.size() == 1;
    if (!agree)
        rules_.doubt({check.votes.names() + " answer differently, and no other host can be asked about " +
                          describe(*entry.bundle.questions),
                      "", true});
    hand_on(std::move(entry), check.answers.front().first);
}

// Two that agree are believed. Until then another is asked, and another.
// DECISIONS: two-against-one
template <class Question>
void Multiplexer<Question>::weigh(Entry entry) {
    auto& check = *entry.check;
    const auto settled = check.votes.settled();
    if (!settled && check.asked > 1) {
        --check.asked;
        return;
    }
    if (!settled) {
        std::set<Scheduler::Host> asked;
        for (const auto& host : check.votes.hosts()) asked.insert(hosts_.at(host));
        entry.copies.clear();
        return add(std::move(entry), std::move(asked));
    }
    if (counters_) ++counters_->verified;
    for (const auto& host : check.votes.against(*settled))
        rules_.doubt({host + " does not answer as others do: " + check.votes.names() + " were asked about " +
                          describe(*entry.bundle.questions),
                      host, true});
    --check.asked;
    hand_on(std::move(entry), *settled);
}

template <class Question>
void Multiplexer<Question>::hand_on(Entry entry, const Hash& answer) {
    for (auto& [hash, answers] : entry.check->answers)
        if (hash == answer) return deliver(std::move(entry), std::move(answers));
}

template <class Question>
void Multiplexer<Question>::let_dropped_go() {
    std::vector<Entry> dropped;
    std::erase_if(entries_, [&](auto& entry) {
        if (scheduler_.backlog().knows(entry.first)) return false;
        if (entry.second.check) dropped.push_back(std::move(entry.second));
        return true;
    });
    // What one host has answered, when nobody else is asked any more.
    for (auto& entry : dropped)
        if (--entry.check->asked == 0 && !entry.check->votes.empty()) {
            const Hash answer = entry.check->answers.front().first;
            hand_on(std::move(entry), answer);
        }
}

}  // namespace lightnet
