// A host that the launcher reaches by a connection.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "core/base/hash.hpp"
#include "core/readers/files/files.hpp"
#include "core/run/message/counters.hpp"
#include "core/run/message/message.hpp"
#include "transport/launcher/files_for_host.hpp"
#include "transport/launcher/host_connection.hpp"
#include "transport/launcher/host_link.hpp"
#include "transport/launcher/host_news.hpp"
#include "transport/launcher/message_counts.hpp"
#include "transport/launcher/result_holders.hpp"
#include "transport/launcher/run_ports.hpp"
#include "transport/lines/paced_line.hpp"
#include "transport/wire/lease.hpp"
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
    std::shared_ptr<ResultHolders> holders = std::make_shared<ResultHolders>();
};

/// Greets a host, sends it the job and the files that it lacks, waits until its places are ready, and keeps its lease:
/// a host that does not answer three heartbeats in a row, or whose connection was cut, is lost, and greeted anew. One
/// whose answers come late gets longer, and so does a line that is busy with what was sent before.
class RemoteHost final : public HostLink {
public:
    /// Counts what it sends and receives in `counters`, which must outlive it. `name` is that of the host in plans.
    RemoteHost(const RunOffer& offer, Counters& counters, std::string name, std::unique_ptr<HostConnection> connection);

    std::uint64_t progress() const override { return news_.progress; }
    std::uint64_t pulse() const override { return news_.pulse + carried_; }
    Doings doing() const override { return news_.doing; }
    void watch_places() override { watched_ = true; }
    HostFigures figures() const override { return news_.figures; }
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
    void hear(Time now);
    void heartbeat(Time now);
    void look_at_handshake(Time now);
    void look_at_line(Time now, const ExpectedPlan& plan);
    void damaged(Time now, std::span<const std::byte> header);
    void connect_anew(std::optional<std::uint16_t> port, Time now);

    const RunOffer& offer_;
    Counters& counters_;
    std::unique_ptr<HostConnection> connection_;
    HostNews news_;
    RunPorts ports_;
    bool watched_ = false, ask_figures_ = false;
    bool drained_ = false;                // see drain()
    std::uint64_t carried_ = 0;           // parts and files, either way: who waits for his line works, too
    std::optional<Time> next_renewal_{};  // of the connection, which is broken
    std::optional<Time> line_ends_{};     // of the line, which is not
    std::uint64_t renewed_lines_ = 0;
    Lease lease_;
    Time next_call_{}, next_ping_{};
    PacedLine line_;
    const PacedLine::Send socket_;
    FilesForHost files_;
    MessageCounts counts_;
    Time now_{};             // when it was last looked after
    int abandoned_ = 0;      // handshakes, in a row
    bool welcomed_ = false;  // by the host, some time: its keys, or that it has none, were right
};

}  // namespace lightnet
