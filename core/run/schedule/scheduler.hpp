// The scheduler: all decisions of one asker, on who answers what and what to do when answers stay away.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <unordered_map>
#include <variant>
#include <vector>

#include "core/network/graph/strategy.hpp"
#include "core/run/message/credit.hpp"
#include "core/run/schedule/hash_ring.hpp"
#include "core/run/schedule/in_flight.hpp"
#include "core/run/schedule/schedule_ids.hpp"
#include "core/run/schedule/service_times.hpp"
#include "core/run/schedule/stragglers.hpp"
#include "core/run/schedule/suspects.hpp"
#include "core/run/schedule/tournament_tree.hpp"

namespace lightnet {

/// How often those who ask look whether replicas work at what they have.
inline constexpr double seconds_between_pulses = 0.25;

/// A pure state machine: it is told what happens and when, and says what is to be done. It has no clock, socket, thread
/// or random number, so the same events always give the same actions. Every decision takes O(log replicas).
///
/// Work is a bundle of questions, some tiles, or some shards of preparing: all three follow these rules. It is handed
/// out in copies: one, as a rule. A second copy goes to another replica, if that is idle, when the first is overdue
/// (its place may hang, or the network has lost it), or when work runs out (speculative execution, see Stragglers).
/// Neither happens between replicas within the asker's process, where nothing is lost. The first answer counts. Work
/// that fails at one host is asked of another, once. Copies on a host that dies make their work suspect: it is asked
/// again alone, with nothing else on its host, and set aside after its third death alone, see Suspects. With affinity,
/// a region of scene or picture has a home, by consistent hashing, see HashRing. A replica is a place, or a host with
/// several, which work at the same time.
class Scheduler {
public:
    using Time = ScheduleIds::Time;
    using WorkId = ScheduleIds::WorkId;
    using CopyId = ScheduleIds::CopyId;
    using Replica = ScheduleIds::Replica;
    using Host = ScheduleIds::Host;

    struct Rules {
        Strategy strategy = Strategy::fastest;
        bool last_to_idle = false;      // the end of its phases is foreseen: who is busy gets nothing of the last work
        bool double_tail = false;       // idle replicas do what is left once more
        double tail_part = 0.01;        // such a part of all questions may be done twice so ...
        std::size_t tail_least = 4;     // ... and some pieces of work where that saves ...
        double tail_saves = 1;          // ... so many seconds each
        double late = 2;                // times as long as expected: then an idle replica does it once more
        double worth = 0.01;            // seconds: what saves less is not worth it
        double patience = 2;            // seconds without a sign of life that any work may take ...
        double late_factor = 8;         // ... or so many times as long as expected, before it counts as overdue
        double guess = 1;               // seconds that work is expected to take as long as nothing is known ...
        double patience_at_first = 30;  // ... and how long it may
        int deaths_alone = 3;           // that convict
    };

    // ---- what happens ----
    struct Added {  // work that is wanted
        WorkId work;
        std::size_t questions = 1;
        std::size_t bytes = 0;     // of the questions and of the room for the answers
        std::uint64_t region = 0;  // equal for work that shares what replicas may have cached
        std::set<Host> not_at{};   // hosts that may not answer it
    };
    struct Foreseen {  // so many questions will be added later
        std::size_t questions;
    };
    struct Joined {  // a replica that may be asked from now on
        Replica replica;
        Host host;
        std::uint64_t name;  // of the place or host: the same whenever it comes back
        Credit credit;
        std::uint64_t process = 0;    // of the host: one that is back had not died. 0: not known
        std::uint32_t places = 1;     // behind it, which work at the same time
        bool reserve = false;         // the asker itself: asked only when others can't be, or are late
        bool within_process = false;  // of the asker: nothing can be lost on the way
    };
    struct Resized {  // it has other places behind it, or more or fewer
        Replica replica;
        std::uint32_t places;
        Credit credit;
    };
    struct Draining {  // it answers what it has, and is asked no more, until it is not draining any more
        Replica replica;
        bool draining = true;
    };
    struct Gone {  // at the same time
        std::vector<Replica> replicas;
        bool died = true;  // false: they left in good order, and no work is to blame
    };
    struct Replied {
        CopyId copy;
        std::size_t fill = 0;      // questions that wait at the answerer
        double service = 0;        // seconds per question of one of its places, as measured there; 0: not known
        std::size_t answered = 0;  // so many of its questions, if not all; the rest is work of its own. 0: all
    };
    struct Failed {  // by an error at its host, or a wrong answer
        CopyId copy;
    };
    struct Alive {  // it works at what it has
        Replica replica;
    };
    struct Refused {  // it could not be sent after all
        CopyId copy;
    };
    struct Dropped {};  // nobody wants any more what is not under way
    struct Forgotten {  // nobody wants this work any more, under way or not
        WorkId work;
    };
    struct Tick {  // time to decide. `again`: at once after the last one, as something was refused
        bool again = false;
    };
    using Event = std::variant<Added, Foreseen, Joined, Resized, Draining, Gone, Replied, Failed, Alive, Refused,
                               Dropped, Forgotten, Tick>;

    // ---- what is to be done ----
    struct Send {
        CopyId copy;
        WorkId work;
        Replica replica;
        friend bool operator==(const Send&, const Send&) = default;
    };
    struct Accept {  // this answer counts; the work is done
        CopyId copy;
        WorkId work;
        friend bool operator==(const Accept&, const Accept&) = default;
    };
    struct Drop {  // this answer came late
        CopyId copy;
        friend bool operator==(const Drop&, const Drop&) = default;
    };
    struct SetAside {  // this work is given up: it seems to kill hosts
        WorkId work;
        std::vector<Host> died;  // with nothing else under way
        friend bool operator==(const SetAside&, const SetAside&) = default;
    };
    struct Retry {  // another host is asked
        WorkId work;
        friend bool operator==(const Retry&, const Retry&) = default;
    };
    struct GiveUp {  // a second host has failed, too, or there is none that may be asked
        WorkId work;
        friend bool operator==(const GiveUp&, const GiveUp&) = default;
    };
    using Action = std::variant<Send, Accept, Drop, SetAside, Retry, GiveUp>;

    /// What it did, for those who count.
    struct Counts {
        std::uint64_t asked_again = 0;  // copies that went under with their replica
        std::uint64_t doubled = 0;      // copies sent to idle replicas at the end of a phase
        std::uint64_t written_off = 0;  // copies that were overdue
        std::uint64_t retried = 0;      // work that failed at one host, and was asked of another
        std::uint64_t spilled = 0;      // affinity: work that did not go to its home, which had too much
        friend bool operator==(const Counts&, const Counts&) = default;
    };

    explicit Scheduler(Rules rules) : rules_(rules), suspects_(static_cast<std::size_t>(rules.deaths_alone)) {}

    /// Appends to `actions`. Only a Tick sends.
    void on(const Event& event, Time now, std::vector<Action>& actions);

    /// Could more work be sent at once?
    bool has_room() const { return waiting_.empty() && open_.any(); }
    /// Is anything waiting to be sent, or again?
    bool has_waiting() const {
        return !waiting_.empty() || !overdue_.empty() || !suspects_.empty() || !retries_.empty() || !refused_.empty();
    }
    /// Something was refused, and is to be tried again soon.
    bool refused() const { return !refused_.empty(); }
    /// When a Tick is due though nothing else happens. TournamentTree::none: never.
    Time next_tick() const {
        if (!idle_one() || !is_tail() || !may_be_afforded(1, rules_.tail_saves)) return stragglers_.next_overdue();
        const double later = may_be_afforded(1, 0) ? 0 : rules_.tail_saves;
        return std::min(stragglers_.next_overdue(), stragglers_.late() + later);
    }
    /// Replicas that have not gone.
    std::size_t replicas() const { return present_; }
    /// Places behind them.
    std::size_t places() const { return places_; }
    /// Of them, those that are open and have a place with nothing to do; the reserve does not count.
    std::size_t idle() const { return idle_count_; }
    /// Are as many idle as have something to do? The reserve counts as idle.
    bool half_idle() const { return 2 * (idle_count_ + reserve_.has_value()) >= present_; }
    /// Seconds per question at one place, on average; 0: not known.
    double service() const { return times_.mean(); }
    /// Seconds per question that replicas say they work on it; 0: not known.
    double work_of_each() const { return times_.said(); }
    /// Seconds per question that is answered by all together; 0: not known.
    double pace() const { return times_.any() ? 1 / times_.rate() : 0; }
    /// When `replica` would have answered `questions` more, in seconds from now, as far as is known.
    double completion_time(Replica replica, std::size_t questions) const;
    /// When whoever would be asked next would have answered `questions` more, in seconds from now. None: nobody but the
    /// reserve may be asked now.
    std::optional<double> soonest(std::size_t questions) const;
    /// The replica to which a region belongs; only when there is one.
    Replica home(std::uint64_t region) const { return homes_.owner_of(region); }
    std::size_t questions_out() const { return in_flight_.questions(); }
    /// That are not answered: under way, not sent yet, and those of others that wait at the replicas.
    std::size_t questions_ahead() const;
    std::size_t questions_waiting() const { return questions_waiting_; }
    std::size_t copies_out() const { return in_flight_.copies(); }
    /// Where a copy is that is not forgotten.
    std::optional<Replica> replica_of(CopyId copy) const { return in_flight_.replica_of(copy); }
    /// What a copy is of, as long as it is not forgotten.
    std::optional<WorkId> work_of(CopyId copy) const { return in_flight_.work_of(copy); }
    /// Is this work wanted, and not done?
    bool knows(WorkId work) const { return items_.contains(work); }
    /// Is a copy of it under way there, or anywhere?
    bool is_at(WorkId work, Replica replica) const;
    bool is_under_way(WorkId work) const;
    /// Work that is not done.
    std::size_t unfinished() const { return items_.size(); }
    const Counts& counts() const { return counts_; }

private:
    struct Item {
        Added work;
        std::vector<CopyId> copies{};       // under way
        std::vector<CopyId> written_off{};  // an answer would still be welcome
        std::set<Host> failed_at{};
        int failures = 0;
        bool waiting = false;
    };
    struct ReplicaState {
        bool present = false, draining = false, refused = false;
        bool silent = false;  // something is overdue, and no reply has come since it was sent
        bool reserve = false, within_process = false;
        Host host = 0;
        std::uint64_t name = 0, process = 0;
        Credit credit;
        std::uint32_t places = 1;
        std::size_t others = 0;  // questions that others have waiting there
        double patience = 0;
        Time last_reply = 0;
        Time last_sign = 0;  // of life
        std::uint64_t turn = 0;
        std::uint32_t in_turn = 0;  // sent since its last turn
        bool counted_idle = false;
    };

    void happens(const Added& event, Time now);
    void happens(const Foreseen& event, Time) { foreseen_ = event.questions; }
    void happens(const Joined& event, Time now);
    void happens(const Resized& event, Time now);
    void happens(const Draining& event, Time now);
    void happens(const Gone& event, Time now);
    void happens(const Replied& event, Time now);
    void happens(const Failed& event, Time now);
    void happens(const Alive& event, Time now);
    void happens(const Refused& event, Time now);
    void happens(const Dropped& event, Time now);
    void happens(const Forgotten& event, Time now);
    void happens(const Tick& event, Time now);

    void send(Item& item, Replica replica, Time now);
    void finish(WorkId work);
    void wait_again(Item& item);
    void go(Replica replica, bool died, bool alone);
    void ask_again(Item& item);
    void blame(Item& item, const Suspects::Loss& loss);
    Item* item_of(const InFlight::Closed& closed);
    Item* waiting_item(WorkId work);
    std::size_t under_way(Host host) const;
    bool is_busy(Host host) const;
    void expect_again(Time now);
    double late_after(double expected) const {
        return std::max(std::max(rules_.late, times_.spread()) * expected, expected + rules_.worth);
    }
    void measure(Replica replica, const InFlight::Copy& copy, const Replied& reply, Time now);
    void write_off_overdue(Time now);
    bool put_off(Replica replica, Time now);
    void ask_idle(Time now);
    std::optional<Replica> idle_for(const Item& item);
    std::optional<Replica> idle_elsewhere() const;
    void hand_out(Time now);
    Item* first_suspect();
    void test_suspects(Time now);
    void fail(Item& item);
    static bool may_answer(const Item& item, Host host) {
        return !item.failed_at.contains(host) && !item.work.not_at.contains(host);
    }
    bool can_be_retried(const Item& item) const;
    void retry(Time now);
    void put_in_quarantine(Host host);
    void release_hosts();
    void double_tail(Time now);
    bool is_tail() const { return rules_.double_tail && waiting_.empty() && suspects_.empty() && foreseen_ == 0; }
    std::optional<Replica> idle_one() const;
    bool may_be_afforded(std::size_t questions, double saves) const;
    double saved_by(Replica idle, const InFlight::Copy& copy, Time now) const;
    bool may_be_doubled(const InFlight::Copy& copy) const;
    const InFlight::Copy* worth_doubling(Replica idle, Time now) const;

    void at_home(Replica replica);
    bool has_idle_place(Replica replica) const;
    double ahead(Replica replica) const;
    bool open(Replica replica) const;
    double order(Replica replica) const;
    std::optional<Replica> choose(const Item& item);
    Replica best_for(const Item& item);
    bool better_held_back(const Item& item, Replica replica) const;
    bool waits_for_idle(const Item& item, Replica replica) const;
    void refresh(Replica replica);
    void note_size(std::size_t questions);
    void refresh_due(Replica replica);

    Rules rules_;
    std::vector<Action>* actions_ = nullptr;
    std::unordered_map<WorkId, Item> items_;
    std::deque<WorkId> waiting_, retries_;
    std::deque<WorkId> overdue_;          // for who is idle
    std::vector<ReplicaState> replicas_;  // by number
    std::map<Host, std::set<Replica>> hosts_;
    std::vector<Replica> refused_;

    InFlight in_flight_;
    ServiceTimes times_;
    Stragglers stragglers_;
    Suspects suspects_;
    HashRing homes_;       // affinity: to whom regions belong
    TournamentTree open_;  // replicas that take more work, by the order of the strategy
    TournamentTree idle_;  // those of them that have nothing to do, but for the reserve
    TournamentTree all_;   // replicas with known speed, open or not, by completion of usual work
    std::optional<Replica> reserve_;
    std::size_t present_ = 0, places_ = 0, idle_count_ = 0;
    std::size_t elsewhere_ = 0;  // replicas that are not within the process
    std::size_t questions_waiting_ = 0, foreseen_ = 0;
    std::size_t questions_wanted_ = 0;  // of work that is not done
    std::size_t questions_added_ = 0, questions_doubled_ = 0;
    double mean_size_ = 0, usual_ = 0;  // questions of work lately; by how many replicas are compared
    std::uint64_t turn_ = 0;
    Counts counts_;
};

}  // namespace lightnet
