// Load balancing: one channel made of several equal ones; questions go where they will be answered first.
#pragma once

#include <algorithm>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <type_traits>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/hash.hpp"
#include "core/network/light/describe_question.hpp"
#include "core/run/message/channel.hpp"
#include "core/run/message/counters.hpp"
#include "core/run/message/region.hpp"
#include "core/run/schedule/answers.hpp"
#include "core/run/schedule/scheduler.hpp"
#include "core/run/schedule/spot_checks.hpp"
#include "core/run/schedule/votes.hpp"

namespace lightnet {

/// The seconds of the steady clock.
inline double steady_seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// How a multiplexer works.
struct MultiplexerRules {
    Scheduler::Rules scheduling;
    std::size_t least_piece = 64;   // questions; bundles are cut into no smaller pieces
    double worth_cutting = 500e-6;  // seconds; what takes less stays whole
    /// Answers that come twice are compared bit for bit, and this is told when they differ; empty: they are not.
    std::function<void(const std::string& what)> differs;
    /// Told of work that failed at a host and is asked of another.
    std::function<void(const Failure& failure)> at_fault = [](const Failure&) {};
    bool names_host = false;  // what fails for good keeps the host where it did: for who only passes questions on
    /// Work that two hosts are asked, so that their answers can be compared before one of them counts.
    SpotChecks checks;
    std::optional<std::string> own;  // the host that need not be checked: the asker's
    /// Told of a host that answers otherwise than two others, or than the asker's own; or, without a name, that two
    /// hosts differ and there is no third.
    std::function<void(const Failure& lie)> doubt = [](const Failure&) {};
    std::function<double()> clock = steady_seconds;
};

/// Does what its Scheduler decides. Serves light, rendering and shards of preparing, threads and hosts alike, and may
/// be made of multiplexers: whoever asks other hosts deals to hosts, and each of those to its places. Bundles that are
/// large for what they cost are cut up, so that idle replicas share them; with affinity, every replica gets the
/// questions of its regions. Bundles come back to their owner answered, failed or set aside, never returned: what a
/// lost replica had is asked again here, and in halves if it was lost twice on the way to a host that did not die. Does
/// not own its channels; used by one thread.
template <class Question>
class Multiplexer final : public Channel<Question>, private BundleOwner<Question> {
public:
    using Time = std::chrono::steady_clock::time_point;

    Multiplexer() = default;
    explicit Multiplexer(std::vector<Channel<Question>*> channels, MultiplexerRules rules = {}) {
        follow(std::move(rules));
        use(std::move(channels));
    }

    /// Before it has channels. Counts in `counters`, if given, which must outlive it.
    void follow(MultiplexerRules rules, Counters* counters = nullptr) {
        rules_ = std::move(rules);
        scheduler_ = Scheduler(rules_.scheduling);
        counters_ = counters;
    }

    /// From now on, these. Those of them that are `draining` answer what they have, and are asked no more; they may be
    /// so, or not, again and again. Those that are missing were lost, unless they were draining.
    void use(std::vector<Channel<Question>*> channels, const std::vector<Channel<Question>*>& draining = {});
    /// Whether hosts may still join: until none will, what only those that are there have failed at waits for them.
    void expect_hosts(bool more);
    /// So many more questions will come: until then it is not the end of a phase.
    void foresee(std::size_t questions) { tell(Scheduler::Foreseen{questions}); }
    /// Are as many replicas idle as have something to do?
    bool half_idle() const { return scheduler_.half_idle(); }
    /// What is known of replicas that had nothing to do for so many seconds is old: most of what makes them look slow
    /// is forgotten.
    void fade(double after) { tell(Scheduler::Faded{after}); }
    /// Nobody wants any more what is not under way.
    void drop_waiting() { tell(Scheduler::Dropped{}); }
    /// Nobody wants this bundle any more, under way or not. It doesn't come back to its owner.
    void forget(const Bundle<Question>& bundle);

    /// Replicas.
    std::size_t size() const { return scheduler_.replicas().present(); }
    /// May a bundle be sent that would leave at once?
    bool has_credit() const { return scheduler_.has_room(); }
    /// Is anything waiting for credit, or to be tried again?
    bool has_waiting() const { return scheduler_.has_waiting(); }
    std::size_t outstanding() const { return scheduler_.in_flight().questions(); }
    /// Questions that are under way, and those that wait for credit.
    std::size_t unanswered() const {
        return scheduler_.in_flight().questions() + scheduler_.backlog().questions().waiting;
    }
    std::size_t bundles_outstanding() const { return scheduler_.in_flight().copies(); }
    const Scheduler& scheduler() const { return scheduler_; }

    /// Takes a bundle, and sends it when a replica is free. Always true.
    bool send(const Bundle<Question>& bundle) override;
    /// Sends what has become due. Call it several times a second. True if anything was sent.
    bool tick();
    /// How long until a tick is due though nothing arrives.
    std::chrono::nanoseconds until_due() const;

    Credit credit() const override;
    Load load() const override;
    /// Of all replicas together.
    std::uint32_t places() const override { return static_cast<std::uint32_t>(scheduler_.replicas().places()); }

private:
    struct Slot {
        Channel<Question>* channel = nullptr;
        bool draining = false;
        std::string host;
        std::uint32_t places = 1;
        std::uint64_t pulse = 0;
        std::uint64_t process = 0;
    };
    // A bundle that was cut up.
    struct Whole {
        Bundle<Question> bundle;
        std::vector<Rgb> answers;
        std::vector<std::size_t> at{};  // where those to each question begin, if questions have not equally many
        std::size_t missing = 0;        // pieces
        bool given_up = false;
    };
    // Work that several hosts are asked. All entries of it share it; the last that comes back hands on the answers.
    struct Check {
        Votes votes;
        std::vector<std::pair<Hash, Answers<Question>>> answers;  // that differ
        std::size_t asked = 1;                                    // entries of it that are not back
        bool begun = false;                                       // a second host is asked
    };
    struct Entry {
        Bundle<Question> bundle;
        std::shared_ptr<Whole> whole;      // null: the bundle is its own
        std::vector<std::uint32_t> where;  // index in the whole, of each question
        std::vector<Scheduler::CopyId> copies;
        Failure failure{};               // the last
        std::shared_ptr<Check> check{};  // null: one host is asked
        std::vector<Scheduler::Host> lost_at{};
    };

    void answered(const Bundle<Question>& bundle, Answers<Question> answers) override {
        replied(bundle, std::move(answers));
    }
    void failed(const Bundle<Question>& bundle, const Failure& failure) override;
    void returned(Bundle<Question> bundle) override { tell(Scheduler::Refused{bundle.number}); }

    void tell(const Scheduler::Event& event);
    struct Performed {
        bool sent = false, refused = false, more = false;
    };
    Performed perform(const std::vector<Scheduler::Action>& actions);
    void add_replica(Channel<Question>* channel);
    void feel_pulses();
    void replied(const Bundle<Question>& bundle, Answers<Question> answers);
    Entry* entry_of(Scheduler::CopyId copy);
    void deliver(Entry entry, Answers<Question> answers);
    void give_up(const Entry& entry, const Failure& failure, bool set_aside);
    void settle(const std::vector<Scheduler::Action>& actions);
    void set_aside_work(const Scheduler::SetAside& verdict);
    void compare_later(const Entry& entry, Scheduler::CopyId first, const Answers<Question>& answers);
    void compare(Scheduler::CopyId copy, const Answers<Question>& answers);
    std::vector<std::vector<std::uint32_t>> cut(const std::vector<Question>& questions) const;
    std::vector<std::vector<std::uint32_t>> by_home(const std::vector<Question>& questions) const;
    std::shared_ptr<Whole> whole_of(const Bundle<Question>& bundle) const;
    void add_piece(const std::shared_ptr<Whole>& whole, std::vector<std::uint32_t> where);
    void note_loss(const std::vector<Scheduler::Replica>& replicas);
    void halve_what_was_lost_twice(Scheduler::Host host);
    void halve(Scheduler::WorkId work);
    void add(Entry entry, std::set<Scheduler::Host> not_at = {});
    bool ask_another(Entry& entry, Scheduler::Replica asked);
    void heard(Entry entry, const std::string& host, Answers<Question> answers);
    void unheard(Entry entry, const Failure& failure, bool set_aside);
    void weigh(Entry entry);
    void let_dropped_go();
    void hand_on(Entry entry, const Hash& answer);
    void count();

    MultiplexerRules rules_;
    Scheduler scheduler_{rules_.scheduling};
    Counters* counters_ = nullptr;
    Scheduler::Counts counted_;
    std::vector<Slot> slots_;  // by replica
    std::vector<Scheduler::Replica> free_slots_;
    std::map<std::string, Scheduler::Host> hosts_;
    std::vector<std::string> host_names_;
    std::map<Scheduler::Host, std::uint64_t> processes_;  // of those that were lost
    std::unordered_map<Scheduler::WorkId, Entry> entries_;
    std::unordered_map<Scheduler::CopyId, Hash> expected_;  // of copies whose work is done, when checking
    Scheduler::WorkId next_work_ = 1;
    double next_pulse_ = 0;  // seconds of the clock
    bool more_hosts_ = false;
};

}  // namespace lightnet
