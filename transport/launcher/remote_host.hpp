// A host that the launcher reaches by a connection.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "core/base/hash.hpp"
#include "core/readers/files/files.hpp"
#include "core/run/message/counters.hpp"
#include "core/run/message/message.hpp"
#include "transport/launcher/host_connection.hpp"
#include "transport/launcher/host_link.hpp"
#include "transport/launcher/run_ports.hpp"
#include "transport/lines/paced_line.hpp"
#include "transport/wire/lease.hpp"
#include "transport/wire/line_pace.hpp"
#include "transport/wire/packet.hpp"

namespace lightnet {

/// What every host is told of the run. Outlives the links.
struct RunOffer {
    std::uint64_t run = 0;
    std::string who;  // runs it, for those who have to wait
    std::string isa;
    std::uint64_t fingerprint = 0;
    std::string job;  // as text
    std::map<Hash, Bytes> blobs;
    std::chrono::milliseconds line_life{};  // after which a line with keys gets new ones
    std::string members{};                  // keys of all its hosts, see AllowList; changes as they come
    std::string numbers{};                  // addresses of those that have names; likewise
};

/// Greets a host, sends it the job and the files that it lacks, waits until its places are ready, and keeps its lease:
/// a host that does not answer three heartbeats in a row, or whose connection was cut, is lost, and greeted anew. One
/// whose answers come late gets longer, and so does a line that is busy with what was sent before.
class RemoteHost final : public HostLink {
public:
    /// Counts what it sends and receives in `counters`, which must outlive it. `name` is that of the host in plans.
    RemoteHost(const RunOffer& offer, Counters& counters, std::string name, std::unique_ptr<HostConnection> connection);

    std::uint64_t progress() const override { return progress_; }  // as of its last heartbeat
    std::uint64_t pulse() const override { return pulse_ + carried_; }
    Doings doing() const override { return doing_; }  // the same
    void watch_places() override { watched_ = true; }
    HostFigures figures() const override { return figures_; }  // the same
    std::uint64_t renewed_lines() const override { return renewed_lines_; }
    void watch(Poll& poll) override { connection_->watch(poll); }
    std::string answering_at() const override { return connection_->answering_at(); }
    std::string silence() const override { return connection_->trouble(); }
    void tick(Time now, const ExpectedPlan& plan) override;
    bool receive(Time now, const Handlers& handlers) override;
    bool send(Message& message, std::uint32_t place) override;
    bool forward_ask(Frames& frames, std::uint32_t) override { return forward(frames); }
    bool forward_reply(const RelayAddress&, Frames& frames) override { return forward(frames); }
    void request_resend() override;
    void tell_members() override;
    void use(const WrittenPlan& plan) override;
    bool bring(const Hash& name, const Bytes& bytes) override;
    bool take_out(const std::string& why) override;
    bool drain() override;
    void lose(Time now, const std::string& why) override;
    void send_end() override;
    Counters wait_for_end() override { return {}; }

private:
    bool forward(Frames& frames);
    std::optional<Frames> next_message(Time now);
    bool send(packet::Type type, const packet::Fields& fields);
    void control(packet::Type type, const packet::Fields& fields, Time now);
    void welcome(const packet::Fields& fields);
    void take_end(const packet::Fields& fields);
    void queue_blobs(const std::string& hashes);
    void queue_blob(const Hash& hash);
    Bytes blob(const Hash& hash) const;
    void send_blobs(Time now);
    static LinePace pace_of_files();
    bool pieces_out() const { return files_.under_way() > 0; }
    void hear(Time now);
    void heartbeat(Time now);
    void look_at_handshake(Time now);
    void look_at_line(Time now, const ExpectedPlan& plan);
    packet::Fields job_with(const std::string& plan) const;
    std::string why_no_handshake(Handshake seen) const;
    bool lacks_something(const packet::Fields& pong);
    void damaged(Time now, std::span<const std::byte> header);
    void connect_anew(std::optional<std::uint16_t> port, Time now);

    const RunOffer& offer_;
    Counters& counters_;
    std::unique_ptr<HostConnection> connection_;
    Doings doing_;
    /// How far its clock is ahead of ours, nanoseconds.
    struct Clock {
        std::int64_t ahead = 0;
        std::uint64_t error = ~std::uint64_t{0};  // at most
        // The host read its clock between our question and its answer: what took least time tells most.
        void compare(std::uint64_t asked_at, std::uint64_t its_clock, std::uint64_t now) {
            if (asked_at > now || (now - asked_at) / 2 >= error) return;
            error = (now - asked_at) / 2;
            ahead = static_cast<std::int64_t>(its_clock - (asked_at + error));
        }
    };
    Clock clock_;
    RunPorts ports_;
    HostFigures figures_;
    bool watched_ = false, ask_figures_ = false;
    bool drained_ = false;  // see drain()
    std::uint64_t progress_ = 0, pulse_ = 0;
    std::uint64_t carried_ = 0;           // parts and files, either way: who waits for his line works, too
    std::optional<Time> next_renewal_{};  // of the connection, which is broken
    std::optional<Time> line_ends_{};     // of the line, which is not
    std::uint64_t renewed_lines_ = 0;
    Lease lease_;
    Time next_call_{}, next_ping_{}, piece_taken_{};
    // Messages that this end and the other have counted. What lies between their counts is the same on an undamaged
    // connection at each heartbeat.
    struct Between {
        std::uint64_t line, asks, replies;
        friend bool operator==(const Between&, const Between&) = default;
    };
    PacedLine line_;
    const PacedLine::Send socket_;
    LinePace files_ = pace_of_files();
    Time now_{};  // when it was last looked after
    std::uint64_t received_ = 0;
    std::uint64_t arrived_ = 0;  // of those sent, at least
    std::optional<Between> between_;
    struct PieceAt {
        Hash hash;
        std::uint64_t offset;  // of what is still to be sent
    };
    std::deque<PieceAt> pieces_;
    struct Brought {
        Bytes bytes;
        bool here = false;
    };
    std::map<Hash, Brought> brought_;
    int abandoned_ = 0;      // handshakes, in a row
    bool welcomed_ = false;  // by the host, some time: its keys, or that it has none, were right
};

}  // namespace lightnet
