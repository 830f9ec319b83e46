// Events and actions of a scheduler, and the rules that it follows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <variant>
#include <vector>

#include "core/network/graph/strategy.hpp"
#include "core/run/message/credit.hpp"
#include "core/run/schedule/schedule_ids.hpp"

namespace lightnet {

/// A namespace of types.
struct ScheduleTerms : ScheduleIds {
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
    struct HostsExpected {  // others may still join, or none will
        bool more;
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
    struct Faded {  // what is known of replicas that had nothing to do for so many seconds is old
        double after;
    };
    struct Dropped {};  // nobody wants any more what is not under way
    struct Forgotten {  // nobody wants this work any more, under way or not
        WorkId work;
    };
    struct Tick {  // time to decide. `again`: at once after the last one, as something was refused
        bool again = false;
    };
    using Event = std::variant<Added, Foreseen, Joined, HostsExpected, Resized, Draining, Gone, Replied, Failed, Alive,
                               Refused, Faded, Dropped, Forgotten, Tick>;

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
    struct GiveUp {  // a second host has failed, too, or there is none that may be asked, nor will be
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
};

}  // namespace lightnet
