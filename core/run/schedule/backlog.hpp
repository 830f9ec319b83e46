// The backlog of a scheduler: work that is wanted and not done, and what of it waits to be sent.
#pragma once

#include <cstddef>
#include <deque>
#include <set>
#include <unordered_map>
#include <vector>

#include "core/run/schedule/schedule_terms.hpp"

namespace lightnet {

/// Keeps work, and the queues in which it waits. Work that is done may still stand in a queue: it is skipped there. One
/// thread's.
class Backlog {
public:
    using WorkId = ScheduleIds::WorkId;
    using CopyId = ScheduleIds::CopyId;
    using Queue = std::deque<WorkId>;

    struct Item {
        ScheduleTerms::Added work;
        std::vector<CopyId> copies{};       // under way
        std::vector<CopyId> written_off{};  // an answer would still be welcome
        std::set<ScheduleIds::Host> failed_at{};
        int failures = 0;
        bool waiting = false;

        bool may_be_answered_at(ScheduleIds::Host host) const {
            return !failed_at.contains(host) && !work.not_at.contains(host);
        }
        bool under_way_or_waiting() const { return !copies.empty() || waiting; }
    };
    struct Queues {
        Queue first;    // in order
        Queue retries;  // what some hosts may not answer
        Queue overdue;  // for who is idle
    };
    struct Questions {
        std::size_t waiting = 0;   // to be sent
        std::size_t wanted = 0;    // of work that is not done
        std::size_t added = 0;     // ever
        std::size_t foreseen = 0;  // to be added later
    };

    void add(const ScheduleTerms::Added& work);
    void foresee(std::size_t questions) { questions_.foreseen = questions; }
    /// It is wanted no more, or done.
    Item take(WorkId work);
    /// It waits, in a queue that the caller knows; it is sent.
    void wait(Item& item);
    void sent(Item& item);

    /// Null: it is not wanted, or done.
    Item* find(WorkId work);
    const Item* find(WorkId work) const;
    /// Null also when it does not wait.
    Item* find_waiting(WorkId work);
    /// Takes what stands in a queue now off it, and calls action(item) for what still waits of it, which may put it
    /// back.
    template <class Action>
    void take_each(Queue& queue, const Action& action) {
        for (auto left = queue.size(); left > 0; --left) {
            const auto work = queue.front();
            queue.pop_front();
            if (auto* const item = find_waiting(work)) action(*item);
        }
    }
    bool knows(WorkId work) const { return find(work) != nullptr; }
    bool is_under_way(WorkId work) const { return find(work) && !find(work)->copies.empty(); }
    /// Work that is not done.
    std::size_t size() const { return items_.size(); }
    const Questions& questions() const { return questions_; }
    Queues queues;

private:
    std::unordered_map<WorkId, Item> items_;
    Questions questions_;
};

}  // namespace lightnet
