// Two askers and three hosts in every order in which things can happen: a world that is played by a list of steps, and
// says which steps may follow.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

#include "core/run/schedule/scheduler.hpp"

namespace lightnet::test {

/// What may go on in such a world, and how much.
struct WorldBounds {
    std::size_t bundles = 2;  // of each asker
    int faults = 2;           // of all kinds together
    int passes = 1;           // of time while something else could happen
};

/// One thing that happens.
struct WorldStep {
    enum class Kind { work, deliver, notice, pass, come, lose_ask, lose_answer, twice, die, cut };
    Kind kind = Kind::pass;
    std::size_t which = 0;  // replica, message on its way, or notice
    std::size_t at = 0;     // in a replica's queue

    bool is_fault() const { return kind >= Kind::lose_ask; }
};

/// What a state is made of, as a number; equal but for rounding gives the same.
class Digest {
public:
    template <class Value>
    Digest& operator<<(Value value) {
        if constexpr (std::is_floating_point_v<Value>)
            return *this << (std::abs(value) < 1e9 ? std::llround(1e4 * value) : std::numeric_limits<long long>::max());
        else
            return add(static_cast<std::uint64_t>(value));
    }
    Digest& operator<<(const std::string& text) { return add(std::hash<std::string>()(text)); }
    std::uint64_t hash() const { return hash_; }

private:
    Digest& add(std::uint64_t number) {
        hash_ = (hash_ ^ number) * 0x9e3779b97f4a7c15u;
        hash_ ^= hash_ >> 29;
        return *this;
    }
    std::uint64_t hash_ = 0xcbf29ce484222325u;
};

/// Two real Schedulers, each of which wants some bundles, and three hosts of one place each, which answer one copy
/// after the other. What is wrong with it stands in `wrong`.
class InterleavedWorld {
public:
    explicit InterleavedWorld(const WorldBounds& bounds) : bounds_(bounds) {
        for (auto& asker : askers_) {
            for (Scheduler::Replica replica = 0; replica < replicas_.size(); ++replica) join(asker, replica);
            for (Scheduler::WorkId work = 1; work <= bounds.bundles; ++work)
                tell(asker, Scheduler::Added{.work = work});
            tell(asker, Scheduler::Tick{});
        }
    }

    void take(const WorldStep& step) {
        using Kind = WorldStep::Kind;
        if (step.is_fault()) ++faults_;
        switch (step.kind) {
            case Kind::work:
                return work(step.which);
            case Kind::deliver:
                return deliver(step.which);
            case Kind::notice:
                return notice(step.which);
            case Kind::pass:
                if (must_go_on()) ++passes_;
                return pass();
            case Kind::come:
                return come(step.which);
            case Kind::lose_ask:
                replicas_[step.which].queue.erase(replicas_[step.which].queue.begin() + std::ptrdiff_t(step.at));
                return;
            case Kind::lose_answer:
                answers_.erase(answers_.begin() + std::ptrdiff_t(step.which));
                return;
            case Kind::twice:
                answers_.push_back(answers_[step.which]);
                return;
            case Kind::die:
                return go(step.which, true);
            case Kind::cut:
                return go(step.which, false);
        }
    }

    /// All that may happen next. Nothing: all is done, and nothing is on its way.
    std::vector<WorldStep> steps() const {
        using Kind = WorldStep::Kind;
        std::vector<WorldStep> steps;
        for (std::size_t i = 0; i < replicas_.size(); ++i)
            if (!replicas_[i].queue.empty()) steps.push_back({Kind::work, i});
        for (std::size_t i = 0; i < answers_.size(); ++i) steps.push_back({Kind::deliver, i});
        for (std::size_t i = 0; i < notices_.size(); ++i) steps.push_back({Kind::notice, i});
        if (done() && steps.empty()) return steps;
        if (steps.empty() || passes_ < bounds_.passes) steps.push_back({Kind::pass});
        for (std::size_t i = 0; i < replicas_.size(); ++i)
            if (!replicas_[i].there && notices_.empty()) steps.push_back({Kind::come, i});
        if (faults_ < bounds_.faults && !done()) add_faults(steps);
        return steps;
    }

    bool done() const {
        return std::all_of(askers_.begin(), askers_.end(),
                           [](const auto& asker) { return asker.scheduler.backlog().size() == 0; });
    }
    const std::string& wrong() const { return wrong_; }
    /// Of all askers.
    Scheduler::Counts counts() const {
        Scheduler::Counts sum;
        for (const auto& asker : askers_) {
            const auto& counts = asker.scheduler.counts();
            sum.asked_again += counts.asked_again, sum.written_off += counts.written_off;
            sum.doubled += counts.doubled;
        }
        return sum;
    }

    /// All that decides what may follow, times as seconds from now, copies by the order in which they were sent.
    std::uint64_t digest() const {
        Digest text;
        const auto known = known_copies();
        text << faults_ << passes_ << idle_passes_;
        for (const auto& replica : replicas_) {
            text << replica.there << replica.process;
            for (const auto& ask : replica.queue) text << ask.asker << rank(known, ask);
        }
        std::multiset<std::array<std::size_t, 3>> answers, notices;  // whose order decides nothing
        for (const auto& [ask, fill] : answers_) answers.insert({ask.asker, rank(known, ask), fill});
        for (const auto& one : notices_) notices.insert({one.asker, one.replica, one.died});
        for (const auto& of : {answers, notices}) {
            text << of.size();
            for (const auto& one : of) text << one[0] << one[1] << one[2];
        }
        for (const auto& asker : askers_) describe(text, known[asker.number], asker);
        return text.hash();
    }

private:
    struct Ask {
        std::size_t asker;
        Scheduler::CopyId copy;
    };
    struct Answer {
        Ask ask;
        std::size_t fill;
    };
    struct Notice {
        std::size_t asker;
        Scheduler::Replica replica;
        bool died;
    };
    struct Replica {
        bool there = true;
        std::uint64_t process = 1;
        std::deque<Ask> queue{};
    };
    struct Asker {
        std::size_t number;
        Scheduler scheduler{{}};
        std::map<Scheduler::WorkId, int> accepted{};
        std::set<Scheduler::Replica> knows{};
        std::string blamed{};  // what was under way at deaths
    };
    static constexpr std::size_t credit = 1;      // bundles
    static constexpr int most_idle_passes = 100;  // of time, until something must have happened

    bool must_go_on() const {
        return !answers_.empty() || !notices_.empty() ||
               std::any_of(replicas_.begin(), replicas_.end(), [](const auto& one) { return !one.queue.empty(); });
    }

    void add_faults(std::vector<WorldStep>& steps) const {
        using Kind = WorldStep::Kind;
        for (std::size_t i = 0; i < replicas_.size(); ++i) {
            for (std::size_t at = 0; at < replicas_[i].queue.size(); ++at) steps.push_back({Kind::lose_ask, i, at});
            if (replicas_[i].there) steps.push_back({Kind::die, i}), steps.push_back({Kind::cut, i});
        }
        for (std::size_t i = 0; i < answers_.size(); ++i)
            steps.push_back({Kind::lose_answer, i}), steps.push_back({Kind::twice, i});
    }

    void work(std::size_t i) {
        auto& queue = replicas_[i].queue;
        const Ask ask = queue.front();
        queue.pop_front();
        answers_.push_back({ask, queue.size()});
    }
    void deliver(std::size_t i) {
        const Answer answer = answers_[i];
        answers_.erase(answers_.begin() + std::ptrdiff_t(i));
        auto& asker = askers_[answer.ask.asker];
        tell(asker, Scheduler::Replied{answer.ask.copy, answer.fill, 0.1});
        tell(asker, Scheduler::Tick{});
    }
    void go(std::size_t i, bool died) {
        replicas_[i].there = false, replicas_[i].queue.clear();
        for (std::size_t asker = 0; asker < askers_.size(); ++asker)
            notices_.push_back({asker, Scheduler::Replica(i), died});
    }
    void notice(std::size_t i) {
        const Notice one = notices_[i];
        notices_.erase(notices_.begin() + std::ptrdiff_t(i));
        auto& asker = askers_[one.asker];
        asker.knows.erase(one.replica);
        std::ostringstream blamed;
        blamed << one.replica << one.died;
        for (const auto& copy : asker.scheduler.in_flight().of(one.replica).copies) blamed << '.' << copy.work;
        asker.blamed += blamed.str() + ' ';
        tell(asker, Scheduler::Gone{{one.replica}, one.died});
        tell(asker, Scheduler::Tick{});
    }
    void come(std::size_t i) {
        replicas_[i].there = true, ++replicas_[i].process;
        for (auto& asker : askers_) {
            join(asker, Scheduler::Replica(i));
            tell(asker, Scheduler::Tick{});
        }
    }
    void join(Asker& asker, Scheduler::Replica replica) {
        asker.knows.insert(replica);
        tell(asker, Scheduler::Joined{replica, replica, replica, {credit, 100}, replicas_[replica].process});
    }

    // Until an asker has something to decide. Who works at something gives a sign of life.
    void pass() {
        double until = now_ + 10;
        for (const auto& asker : askers_)
            if (asker.scheduler.next_tick() > now_) until = std::min(until, asker.scheduler.next_tick());
        now_ = until;
        if (++idle_passes_ > most_idle_passes) complain("nothing happens any more, and work is left");
        for (auto& asker : askers_) {
            for (const auto replica : asker.knows)
                if (!replicas_[replica].queue.empty()) tell(asker, Scheduler::Alive{replica});
            tell(asker, Scheduler::Tick{});
        }
        if (must_go_on()) idle_passes_ = 0;
    }

    void tell(Asker& asker, const Scheduler::Event& event) {
        std::vector<Scheduler::Action> actions;
        asker.scheduler.on(event, now_, actions);
        for (const auto& action : actions) obey(asker, action);
        check(asker);
    }
    void obey(Asker& asker, const Scheduler::Action& action) {
        if (const auto* send = std::get_if<Scheduler::Send>(&action)) {
            if (!asker.knows.contains(send->replica)) complain("somebody who is gone is asked");
            auto& replica = replicas_[send->replica];
            if (replica.there) replica.queue.push_back({asker.number, send->copy});
        } else if (const auto* accept = std::get_if<Scheduler::Accept>(&action)) {
            if (++asker.accepted[accept->work] > 1) complain("work is answered twice");
        } else if (!std::holds_alternative<Scheduler::Drop>(action)) {
            complain("work is given up");
        }
    }
    void check(const Asker& asker) {
        std::size_t questions = 0, copies = 0;
        for (Scheduler::Replica replica = 0; replica < asker.scheduler.replicas().end(); ++replica) {
            const auto& account = asker.scheduler.in_flight().of(replica);
            if (account.copies.size() > credit) complain("more is under way than the credit allows");
            if (account.questions != account.copies.size()) complain("the account of a replica is wrong");
            questions += account.questions, copies += account.copies.size();
        }
        if (questions != asker.scheduler.in_flight().questions() || copies != asker.scheduler.in_flight().copies())
            complain("the sum of what is under way is wrong");
        const std::size_t accepted = asker.accepted.size();
        if (added(asker) != accepted + asker.scheduler.backlog().size()) complain("work is lost");
    }
    static std::size_t added(const Asker& asker) { return asker.scheduler.backlog().questions().added; }
    void complain(const char* what) {
        if (wrong_.empty()) wrong_ = what;
    }

    using Copies = std::vector<Scheduler::CopyId>;

    // By asker: copies that anybody still knows of, as they were sent.
    std::array<Copies, 2> known_copies() const {
        std::array<Copies, 2> known;
        for (const auto& replica : replicas_)
            for (const auto& ask : replica.queue) known[ask.asker].push_back(ask.copy);
        for (const auto& [ask, fill] : answers_) known[ask.asker].push_back(ask.copy);
        for (const auto& asker : askers_) {
            auto& copies = known[asker.number];
            for (Scheduler::Replica replica = 0; replica < replicas_.size(); ++replica) {
                const auto& account = asker.scheduler.in_flight().of(replica);
                for (const auto& copy : account.copies) copies.push_back(copy.id);
                for (const auto& [copy, work] : account.written_off) copies.push_back(copy);
            }
            std::sort(copies.begin(), copies.end());
            copies.erase(std::unique(copies.begin(), copies.end()), copies.end());
        }
        return known;
    }
    static std::size_t rank(const Copies& known, Scheduler::CopyId copy) {
        return std::size_t(std::lower_bound(known.begin(), known.end(), copy) - known.begin());
    }
    static std::size_t rank(const std::array<Copies, 2>& known, const Ask& ask) {
        return rank(known[ask.asker], ask.copy);
    }

    void describe(Digest& text, const Copies& known, const Asker& asker) const {
        const auto& scheduler = asker.scheduler;
        text << asker.blamed << asker.accepted.size();
        for (const auto& [work, times] : asker.accepted) text << work;
        for (Scheduler::Replica replica = 0; replica < scheduler.replicas().end(); ++replica) {
            const auto& state = scheduler.replicas()[replica];
            text << asker.knows.contains(replica) << state.present << state.silent << state.refused << state.others
                 << state.patience << state.last_reply - now_ << state.last_sign - now_
                 << scheduler.order().key(replica) << scheduler.order().completion_time(replica, 1);
            const auto& account = scheduler.in_flight().of(replica);
            text << account.copies.size() << account.written_off.size();
            for (const auto& copy : account.copies)
                text << rank(known, copy.id) << copy.work << copy.sent - now_ << copy.expected - now_
                     << copy.late - now_ << copy.overdue - now_;
            for (const auto& [copy, work] : account.written_off) text << rank(known, copy) << work;
        }
        const auto& queues = scheduler.backlog().queues;
        for (const auto* queue : {&queues.first, &queues.retries, &queues.overdue}) {
            text << '|';
            for (const auto work : *queue)
                if (const auto* item = scheduler.backlog().find(work)) text << work << item->waiting;
        }
        text << scheduler.next_tick() - now_ << scheduler.has_waiting();
    }

    WorldBounds bounds_;
    std::array<Asker, 2> askers_{{{0}, {1}}};
    std::array<Replica, 3> replicas_{};
    std::vector<Answer> answers_;  // on their way, in no order
    std::vector<Notice> notices_;  // likewise: who is gone
    int faults_ = 0, passes_ = 0, idle_passes_ = 0;
    double now_ = 0;
    std::string wrong_;
};

}  // namespace lightnet::test
