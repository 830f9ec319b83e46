#include "core/run/schedule/backlog.hpp"

#include <cassert>
#include <utility>

namespace lightnet {

void Backlog::add(const ScheduleTerms::Added& work) {
    assert(!items_.contains(work.work) && "work goes by numbers of its own");
    items_.emplace(work.work, Item{.work = work, .waiting = true});
    (work.not_at.empty() ? queues.first : queues.retries).push_back(work.work);
    questions_.waiting += work.questions;
    questions_.added += work.questions;
    questions_.wanted += work.questions;
}

Backlog::Item Backlog::take(WorkId work) {
    Item item = std::move(items_.extract(work).mapped());
    if (item.waiting) questions_.waiting -= item.work.questions;
    questions_.wanted -= item.work.questions;
    return item;
}

void Backlog::wait(Item& item) {
    item.waiting = true;
    questions_.waiting += item.work.questions;
}

void Backlog::sent(Item& item) {
    if (item.waiting) questions_.waiting -= item.work.questions;
    item.waiting = false;
}

Backlog::Item* Backlog::find(WorkId work) {
    const auto found = items_.find(work);
    return found == items_.end() ? nullptr : &found->second;
}

const Backlog::Item* Backlog::find(WorkId work) const {
    const auto found = items_.find(work);
    return found == items_.end() ? nullptr : &found->second;
}

Backlog::Item* Backlog::find_waiting(WorkId work) {
    auto* const item = find(work);
    return item && item->waiting ? item : nullptr;
}

}  // namespace lightnet
