// Work that may be what kills hosts: who is suspect, on which hosts it is tried alone, and when it is convicted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <set>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/run/schedule/schedule_ids.hpp"

namespace lightnet {

/// Work that was under way on a host when it died is suspect. It is asked again alone, on a host that is in quarantine:
/// with nothing else under way. Deaths with nothing else there convict. A host that comes back as the same process had
/// not died: what was held against work because of it is dropped.
class Suspects {
public:
    using WorkId = ScheduleIds::WorkId;
    using Host = ScheduleIds::Host;

    /// Of a host on which work was under way.
    struct Loss {
        Host host;
        std::uint64_t process;  // 0: not known
        bool alone;             // nothing else was under way there
    };

    /// So many deaths alone convict.
    explicit Suspects(std::size_t deaths_alone) : deaths_alone_(deaths_alone) {}

    bool is_suspect(WorkId work) const { return losses_.contains(work); }
    /// True when that convicts it: see died_alone().
    bool blame(WorkId work, const Loss& loss);
    /// The hosts that died with this work and nothing else under way.
    std::vector<Host> died_alone(WorkId work) const;
    /// The work is done.
    void forget(WorkId work) { losses_.erase(work); }

    /// A process died, or went out of reach.
    void lost(Host host, std::uint64_t process);
    /// It is there again: the work in the queue that is not suspect any more, and leaves the queue.
    std::vector<WorkId> came_back(Host host, std::uint64_t process);

    // ---- the queue ----
    void wait(WorkId work) { queue_.push_back(work); }
    bool empty() const { return queue_.empty(); }
    std::size_t waiting() const { return queue_.size(); }
    WorkId front() const { return queue_.front(); }
    void pop() { queue_.pop_front(); }
    /// All that waits, which waits no more.
    std::deque<WorkId> drop() { return std::exchange(queue_, {}); }

    // ---- hosts that get nothing else ----
    bool in_quarantine(Host host) const { return quarantine_.contains(host); }
    const std::set<Host>& quarantine() const { return quarantine_; }
    void put_in_quarantine(Host host) { quarantine_.insert(host); }
    void release(Host host) { quarantine_.erase(host); }

private:
    std::size_t deaths_alone_;
    std::unordered_map<WorkId, std::vector<Loss>> losses_;  // that it may be to blame for: at least one
    std::deque<WorkId> queue_;
    std::set<Host> quarantine_;
    std::set<std::pair<Host, std::uint64_t>> lost_;  // processes, which may come back
};

}  // namespace lightnet
