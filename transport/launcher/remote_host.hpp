// One host, as the launcher sees it.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/hash.hpp"
#include "core/readers/files.hpp"
#include "core/run/message/counters.hpp"
#include "core/run/message/message.hpp"
#include "transport/launcher/host_connection.hpp"
#include "transport/wire/machine.hpp"
#include "transport/wire/packet.hpp"

namespace lightnet {

/// What every link of a run shares: what hosts are told. Outlives the links.
struct Told {
    std::uint64_t run = 0;
    std::string who;  // runs it, for those who have to wait
    std::string isa;
    std::uint64_t fingerprint = 0;
    std::string job;  // as text
    std::map<Hash, Bytes> blobs;
};

/// Greets a host, sends it the job and the files that it lacks, waits until its places are ready, and keeps its lease:
/// a host that does not answer three heartbeats in a row, or whose connection was cut, is lost, and greeted anew. Time
/// is an argument.
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
    struct Takers {
        std::function<void(Message)> work;                   // a reply
        std::function<void(HostLink&, Frames&)> passing_by;  // [address][header][body]: to or from another host
    };

    /// Counts what it sends and receives in `counters`, which must outlive it. `name` is that of the host in plans.
    HostLink(const Told& told, Counters& counters, std::string name, std::unique_ptr<HostLine> line);
    ~HostLink();

    const std::string& name() const { return name_; }
    State state() const { return state_; }
    bool takes_part() const { return state_ == State::ready || state_ == State::leaving; }
    std::uint32_t places() const { return places_; }
    /// Which process it is; 0 before it has said so.
    std::uint64_t process() const { return process_; }
    /// The state, for display.
    std::string words() const;
    /// Why it is not ready, for display.
    std::string trouble() const;
    /// Why it is refused or lost, or what it waits for.
    const std::string& reason() const { return reason_; }
    /// It says that it can't do its part of the job.
    bool broken() const { return broken_; }
    /// It serves another run, and will be free at some time.
    bool busy() const { return state_ == State::greeted && !reason_.empty(); }
    /// It is neither ready nor out of the question.
    bool pending() const {
        return (state_ == State::greeted && !busy()) || state_ == State::sending || state_ == State::building;
    }
    /// What other hosts failed at, as it says, since the last call.
    std::vector<Failure> take_failures() { return std::exchange(failures_, {}); }
    /// Its counters, once after it has ended the run.
    std::optional<Counters> take_ended() { return std::exchange(ended_, std::nullopt); }
    /// What it said of its machine; bundles and tiles that it says it has answered.
    const Machine& machine() const { return machine_; }
    std::uint64_t progress() const { return progress_; }
    HostLine& line() { return *line_; }

    /// Gives the plan that is to be expected, as text; none when that can't be said yet. Called when it is needed.
    using ExpectedPlan = std::function<std::optional<std::string>()>;
    /// Sends what is due.
    void tick(Time now, const ExpectedPlan& plan);
    /// Takes one message from the host, if there is one. True if there was.
    bool receive(Time now, const Takers& takers);
    bool send(Message& message, std::uint32_t place);
    /// Frames that come from another host.
    bool pass(Frames& frames);
    void send_plan(const std::string& plan);
    /// Sees to it that the host has these bytes. True when it has said so.
    bool bring(const Hash& name, const Bytes& bytes);
    void send_end();
    /// The host gets no more of this run.
    void take_out(const std::string& why);
    /// The host is gone, or what was under way to it; calls it again.
    void lose(Time now, const std::string& why);

private:
    bool send(packet::Type type, const packet::Fields& fields);
    void control(packet::Type type, const packet::Fields& fields, Time now);
    void welcome(const packet::Fields& fields);
    void queue_blobs(const std::string& hashes);
    void queue_blob(const Hash& hash);
    Bytes blob(const Hash& hash) const;
    void send_blobs(Time now);
    void heartbeat(Time now);
    bool lacks_something(const packet::Fields& pong);
    void damaged(Time now, std::span<const std::byte> header);

    const Told& told_;
    Counters& counters_;
    std::string name_;
    std::unique_ptr<HostLine> line_;
    State state_ = State::calling;
    std::string reason_;
    bool broken_ = false;
    std::uint32_t places_ = 0;
    std::uint64_t process_ = 0, progress_ = 0;
    Machine machine_;
    Time heard_{}, next_call_{}, next_ping_{}, chunk_taken_{};
    // Messages that this end and the other have counted. What lies between their counts is the same on an undamaged
    // line at each heartbeat.
    struct Between {
        std::uint64_t line, asks, replies;
        friend bool operator==(const Between&, const Between&) = default;
    };
    std::uint64_t sent_ = 0, received_ = 0;
    std::uint64_t arrived_ = 0;  // of those sent, at least
    std::optional<Between> between_;
    struct Chunk {
        Hash hash;
        std::uint64_t offset;
    };
    std::deque<Chunk> chunks_;
    struct Brought {
        Bytes bytes;
        bool here = false;
    };
    std::map<Hash, Brought> brought_;
    std::size_t chunks_out_ = 0;
    std::optional<Counters> ended_;
    std::vector<Failure> failures_;
};

}  // namespace lightnet
