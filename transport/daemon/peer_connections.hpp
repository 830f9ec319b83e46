// The connections from one host to the others of a run.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/network/graph/plan.hpp"
#include "transport/daemon/peer_addresses.hpp"
#include "transport/lines/host_transport.hpp"
#include "transport/lines/line_book.hpp"
#include "transport/lines/paced_line.hpp"
#include "transport/wire/lease.hpp"

namespace lightnet {

/// One connection to each host that is asked, shared by all places of this one. Looks at nothing but addresses. What is
/// for a host that can't be reached, or is silent, goes to the launcher instead, which passes it on. One thread's.
class PeerConnections {
public:
    using Time = std::chrono::steady_clock::time_point;
    struct Handlers {
        // [header][body], from a host, for a place of ours; or what was asked in nobody's name.
        std::function<void(const std::string& host, const std::string& place, Frames& frames)> reply;
        std::function<void(const std::string& host)> request_resend;           // what was under way to it may be lost
        std::function<void(Frames& frames)> launcher;                          // [place][host][header][body]
        std::function<std::optional<LineKeys>(const std::string& host)> keys;  // by which it is called; none: without
        // Now and then: of so many hosts those that are near, each with the room of all lines to it together.
        std::function<void(LineBook::Entries, std::size_t hosts)> quick = [](auto&&, auto) {};
    };
    /// `me`: this host, as in plans.
    PeerConnections(HostTransport& transport, std::string me, Handlers handlers,
                    std::chrono::milliseconds line_life = usual_line_life);
    PeerConnections(const PeerConnections&) = delete;
    PeerConnections& operator=(const PeerConnections&) = delete;

    /// [place][host][header][body]
    void ask(Frames frames);
    /// Of these hosts those that can be asked without the launcher: those on this machine first, then those with the
    /// quickest lines, as far as they were seen to be.
    std::vector<std::string> nearest(std::vector<std::string> hosts);
    /// Takes in what has come, and sends what has waited for its connection.
    void tick(Time now);
    /// See PeerAddresses.
    void hear(const std::string& lines);
    /// Connections to hosts that are no more are closed.
    void use(const Plan& plan);
    /// Should tick() be called though nothing has come?
    bool due(Time now) const;
    /// Something waits for its connection.
    bool waiting() const;
    void watch(Poll& poll) const;

private:
    struct Peer {
        std::unique_ptr<HostLine> line{};  // none could be had, or may be
        bool greeted = false;              // doors greet each connection with an empty message: the first is expected
        Time opened{};
        bool relayed = false;                // its host can't be reached from here
        std::optional<Time> unreachable{};   // since when
        PacedLine paced{};                   // [address][header][body]
        Lease lease{{}, {}, {}};             // begins with the line
        Time called{};                       // asked whether it is there
        bool calling = false, slow = false;  // it has not said so yet; it takes long to
        std::uint64_t number = 0;            // of this line: each has another
        PacedLine::Send socket() {
            return [this](Frames& frames) { return line->send(frames); };
        }
    };
    Peer& peer(const std::string& host);
    void open(const std::string& host, Peer& to);
    void open_anew(const std::string& host, Peer& to);
    void look_whether_silent(const std::string& host, Peer& to, Time now);
    void give_up(const std::string& host, Peer& to);
    void take(const std::string& host, Peer& to, Frames& frames);
    bool is_quick(const Peer& to) const;
    void tell_quick() const;
    void look_whether_reachable(const std::string& host, Peer& to, Time now);

    HostTransport& transport_;
    std::string me_;
    Handlers handlers_;
    std::chrono::milliseconds line_life_;
    std::map<std::string, Peer> peers_;  // by host
    PeerAddresses addresses_;
    std::size_t hosts_ = 0;  // of the plan, but for this one
    Time looked_{};
    std::uint64_t opened_ = 0;  // lines so far
};

}  // namespace lightnet
