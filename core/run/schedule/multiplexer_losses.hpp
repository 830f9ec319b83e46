// Losses on the way to hosts, as a Multiplexer deals with them; part of multiplexer.hpp.
#pragma once

#include "core/run/schedule/multiplexer.hpp"

namespace lightnet {

// What is lost with a process may be what it died of, and is Suspects' business.
template <class Question>
void Multiplexer<Question>::note_loss(const std::vector<Scheduler::Replica>& replicas) {
    for (const auto replica : replicas) {
        const auto host = hosts_.at(slots_[replica].host);
        processes_[host] = slots_[replica].process;
        for (auto& [work, entry] : entries_)
            if (scheduler_.is_at(work, replica)) entry.lost_at.push_back(host);
    }
}

// The line to it does not stand for as long as such work takes on it.
template <class Question>
void Multiplexer<Question>::halve_what_was_lost_twice(Scheduler::Host host) {
    const auto before = processes_.find(host);
    const auto same = [&](const Slot& slot) { return slot.channel && hosts_.at(slot.host) == host; };
    const auto slot = std::ranges::find_if(slots_, same);
    if (before == processes_.end() || before->second == 0 || slot == slots_.end() || slot->process != before->second)
        return;
    std::vector<Scheduler::WorkId> too_long;
    for (const auto& [work, entry] : entries_)
        if (!entry.check && entry.bundle.questions->size() > 1 && !scheduler_.backlog().is_under_way(work) &&
            std::ranges::count(entry.lost_at, host) > 1)
            too_long.push_back(work);
    for (const auto work : too_long) halve(work);
}

template <class Question>
void Multiplexer<Question>::halve(Scheduler::WorkId work) {
    tell(Scheduler::Forgotten{work});
    Entry entry = std::move(entries_.extract(work).mapped());
    auto& where = entry.where;
    if (!entry.whole) {
        entry.whole = whole_of(entry.bundle);
        where.resize(entry.bundle.questions->size());
        std::iota(where.begin(), where.end(), 0u);
        ++entry.whole->missing;
    }
    const auto middle = where.begin() + static_cast<std::ptrdiff_t>(where.size() / 2);
    ++entry.whole->missing;
    add_piece(entry.whole, {where.begin(), middle});
    add_piece(entry.whole, {middle, where.end()});
}

}  // namespace lightnet
