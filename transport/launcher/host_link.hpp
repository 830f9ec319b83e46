// One host of a run, as the launcher sees it, however it is reached.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/bytes.hpp"
#include "core/base/hash.hpp"
#include "core/network/graph/plan.hpp"
#include "core/run/assembly/activity.hpp"
#include "core/run/message/counters.hpp"
#include "core/run/message/figures.hpp"
#include "core/run/message/message.hpp"
#include "transport/lines/message_frame.hpp"
#include "transport/lines/poll.hpp"
#include "transport/wire/machine.hpp"
#include "transport/wire/relay_address.hpp"

namespace lightnet {

/// A plan, and the same as text, as it travels.
struct WrittenPlan {
    Plan plan;
    std::string text;
};

/// Knows how far a host is, and brings it what the launcher and other hosts have for it. One thread's; nothing waits.
/// Time is an argument.
class HostLink {
public:
    using Time = std::chrono::steady_clock::time_point;
    enum class State {
        calling,
        greeted,
        sending,
        building,
        ready,
        leaving,  // was told to stop; answers what it has
        refused
    };
    /// Who takes what comes from the host and is not for the link itself.
    struct Handlers {
        std::function<void(Message)> work;              // a reply
        std::function<void(HostLink&, Frames&)> relay;  // [address][header][body]: to or from another host
    };
    /// Gives the plan that is to be expected, as text; none when that can't be said yet. Called when it is needed.
    using ExpectedPlan = std::function<std::optional<std::string>()>;

    explicit HostLink(std::string name) : name_(std::move(name)) {}
    virtual ~HostLink() = default;
    HostLink(const HostLink&) = delete;
    HostLink& operator=(const HostLink&) = delete;

    /// As in plans.
    const std::string& name() const { return name_; }
    State state() const { return state_; }
    bool takes_part() const { return state_ == State::ready || state_ == State::leaving; }
    std::uint32_t places() const { return places_; }
    /// Which process it is; 0 before it has said so, and for this one.
    std::uint64_t process() const { return process_; }
    /// Why it is refused or lost, or what it waits for.
    const std::string& reason() const { return reason_; }
    /// It says that it can't do its part of the job.
    bool broken() const { return broken_; }
    /// It and we don't know each other by our keys: it can't be called, as long as nobody mends that.
    bool unknown() const { return unknown_; }
    /// It serves another run, and will be free at some time.
    bool busy() const { return state_ == State::greeted && !reason_.empty(); }
    /// It is neither ready nor out of the question.
    bool pending() const {
        return (state_ == State::greeted && !busy()) || state_ == State::sending || state_ == State::building;
    }
    /// Where it runs, as far as it is known.
    const Machine& machine() const { return machine_; }
    /// The most memory that its process has had in this run, bytes, as far as it is known.
    virtual std::uint64_t peak_memory() const { return peak_memory_; }
    /// Bundles and tiles that it has answered.
    virtual std::uint64_t progress() const = 0;
    /// Grows while its places work, see Gauge::pulse; as of its last heartbeat.
    virtual std::uint64_t pulse() const = 0;
    /// Lines to it that took the place of others, which were old.
    virtual std::uint64_t renewed_lines() const { return 0; }
    /// What its nodes say that they do while they prepare.
    virtual Doings doing() const = 0;
    /// From now on, what its places are at is wanted, too.
    virtual void watch_places() = 0;
    /// As far as is known.
    virtual HostFigures figures() const = 0;
    /// What other hosts failed at, as it says, since the last call.
    std::vector<Failure> take_failures() { return std::exchange(failures_, {}); }
    /// Its counters, once after it has ended the run.
    std::optional<Counters> take_ended() { return std::exchange(ended_, std::nullopt); }

    /// For display: the host, the state, why it is not ready, and that it is.
    virtual std::string title() const { return name_; }
    std::string words() const;
    std::string trouble() const;
    /// Where it answers, in numbers; "": that isn't known.
    virtual std::string answering_at() const { return {}; }
    /// Why it doesn't answer, where that is known.
    virtual std::string silence() const { return {}; }
    virtual std::string ready_words() const { return name_ + " is ready"; }

    /// Adds what it waits for.
    virtual void watch(Poll& poll) = 0;
    /// Does what is due.
    virtual void tick(Time now, const ExpectedPlan& plan) = 0;
    /// Takes in a message, if there is one. True if there may be more. Throws Error when a place of this process died.
    virtual bool receive(Time now, const Handlers& handlers) = 0;
    virtual bool send(Message& message, std::uint32_t place) = 0;
    /// [address][header][body], from another host: an ask for a place, or the reply to one of this host's.
    virtual bool forward_ask(Frames& frames, std::uint32_t place) = 0;
    virtual bool forward_reply(const RelayAddress& asker, Frames& frames) = 0;
    /// Has it send again what it has asked others through the launcher, as it may be lost.
    virtual void request_resend() = 0;
    /// Tells it the keys of all hosts of the run, which have changed.
    virtual void tell_members() {}
    /// It asks by this plan from now on.
    virtual void use(const WrittenPlan& plan) = 0;
    /// Sees to it that the host has these bytes. True when it has.
    virtual bool bring(const Hash& name, const Bytes& bytes) = 0;
    /// It gets no more of this run. False: it must stay.
    virtual bool take_out(const std::string& why) = 0;
    /// It answers what it has, gets no more of this run, and stays away, whatever happens to it meanwhile; one that
    /// takes no part yet never will. False: it can't, or is out already.
    virtual bool drain() = 0;
    /// It is gone, or what was under way to it; it is called again.
    virtual void lose(Time now, const std::string& why) = 0;
    /// Tells it that the run ends. See take_ended().
    virtual void send_end() = 0;
    /// Tells a host that the run ends which must have ended before this process goes on; others count nothing.
    virtual Counters wait_for_end() = 0;

protected:
    std::string unanswered() const;

    std::string name_;
    State state_ = State::calling;
    std::string reason_;
    bool broken_ = false, unknown_ = false;
    std::uint32_t places_ = 0;
    std::uint64_t process_ = 0;
    Machine machine_;
    std::uint64_t peak_memory_ = 0;
    std::vector<Failure> failures_;
    std::optional<Counters> ended_;
};

}  // namespace lightnet
