// Deals out the shards of a call of preparing.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/network/graph/plan.hpp"
#include "core/run/schedule/scheduler.hpp"

namespace lightnet {

/// A node at one place; a place may hold several of those that stand for the sectors of one.
struct NodeCopy {
    PlaceAt place;
    std::size_t node;
    friend auto operator<=>(const NodeCopy&, const NodeCopy&) = default;
};

/// Shards of a call, one behind the other.
struct Shards {
    std::uint32_t first = 0, count = 0;
    friend bool operator==(const Shards&, const Shards&) = default;
};

/// Hands every shard to one of the copies that wait for the call's result, by the rules by which light and tiles are
/// handed out, see Scheduler: credit, what is late, what is done twice, what may kill hosts. Several quick shards go
/// together, and may be answered in part.
class ShardDealer {
public:
    using Time = Scheduler::Time;
    using CopyId = Scheduler::CopyId;
    /// Shards that are to be sent.
    struct Deal {
        CopyId id;
        NodeCopy to;
        Shards shards;
    };
    /// A shard that hosts died of, with nothing else to do.
    struct Convicted {
        std::uint32_t shard;
        std::vector<std::string> hosts;
    };

    ShardDealer();
    /// Shards 0 to count - 1 are to be done, once more if they were done before. What was sent until now does not count
    /// any more, and nobody has joined.
    void begin(std::uint32_t count);

    /// Waits for the result, and does shards from now on. It may be told again: then it is false.
    bool join(const NodeCopy& copy, std::uint64_t process, Time now);
    /// Has it joined?
    bool has(const NodeCopy& copy) const { return joined_.contains(copy); }
    /// Of those who have joined, the ones in `there` go on; others of the plan's places answer what they have and are
    /// asked no more; the rest is lost.
    void keep(const Plan& plan, const std::set<NodeCopy>& there, Time now);

    /// What is due. `copies`: how many share the shards, or soon will.
    std::vector<Deal> deal(std::size_t copies, Time now);
    /// Looks, several times a second, who works at what he has. `pulse`: of a host, see Carrier.
    void feel_pulses(const std::function<std::uint64_t(const std::string&)>& pulse, Time now);
    /// It could not be sent.
    void refused(CopyId id, Time now);

    /// None: its answer does not count any more.
    std::optional<Shards> shards_of(CopyId id) const;
    /// The first `done` of its shards are answered; others are handed out again. False: this answer came late.
    bool answered(CopyId id, std::uint32_t done, Time now);
    /// A shard that has been answered is asked of another host than these as well.
    void ask_also(std::uint32_t shard, const std::vector<std::string>& hosts, Time now);
    /// Is it of such a shard?
    bool is_asked_also(CopyId id) const;
    /// Such shards that nobody else can be asked about, since the last call.
    std::vector<std::uint32_t> take_unasked() { return std::exchange(unasked_, {}); }
    /// Where it was sent. None: its answer does not count any more.
    std::optional<std::string> host_of(CopyId id) const;
    /// It failed there, and somebody else will be asked. False: that came late.
    bool failed(CopyId id, Time now);
    /// None: nobody died of one.
    const std::optional<Convicted>& convicted() const { return convicted_; }

private:
    using Actions = std::vector<Scheduler::Action>;
    Actions tell(const Scheduler::Event& event, Time now);
    std::optional<Scheduler::CopyId> known(CopyId id) const;
    Shards take_next(std::size_t copies);
    void put_back(const Shards& shards);
    void set_aside(const Scheduler::SetAside& verdict);
    void give_up(Scheduler::WorkId work);
    void add(const Shards& shards, std::set<Scheduler::Host> not_at, Time now);

    Scheduler scheduler_;
    std::uint64_t rounds_ = 0;  // that have begun; above the scheduler's number of a copy
    std::map<NodeCopy, Scheduler::Replica> joined_;
    std::vector<NodeCopy> copies_;  // by replica, lost ones too
    std::set<NodeCopy> draining_;
    std::vector<std::string> hosts_;  // by number
    std::map<std::string, std::uint64_t> pulses_;
    Time next_pulse_ = 0;
    std::unordered_map<Scheduler::WorkId, Shards> works_;
    std::deque<std::uint32_t> to_do_;   // in nobody's hands
    std::vector<std::uint32_t> alone_;  // and these, one by one
    std::set<Scheduler::WorkId> also_;  // works that are asked once more
    std::vector<std::uint32_t> unasked_;
    std::optional<Convicted> convicted_;
    Scheduler::WorkId next_work_ = 1;
};

}  // namespace lightnet
