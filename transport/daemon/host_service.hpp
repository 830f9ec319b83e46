// The parts of a host. For the .cpp files of hosts.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "transport/daemon/arriving_job.hpp"
#include "transport/daemon/background_work.hpp"
#include "transport/daemon/bounded_log.hpp"
#include "transport/daemon/ended_runs.hpp"
#include "transport/daemon/host.hpp"
#include "transport/daemon/host_door.hpp"
#include "transport/daemon/host_rights.hpp"
#include "transport/daemon/hosted_run.hpp"
#include "transport/daemon/peer_connections.hpp"
#include "transport/daemon/place_traffic.hpp"
#include "transport/daemon/shown_figures.hpp"
#include "transport/store/blob_cache.hpp"
#include "transport/wire/lease.hpp"
#include "transport/wire/machine.hpp"
#include "transport/wire/packet.hpp"
#include "transport/zmq/gateway.hpp"
#include "transport/zmq/zmq_hosts.hpp"

namespace lightnet {

/// The host itself. What it serves is one run at a time; all of it belongs to the thread of serve(), which leaves the
/// door and the traffic of its places to these while it rests.
struct Host::Service {
    using Time = std::chrono::steady_clock::time_point;
    std::shared_ptr<const SocketContext> context = std::make_shared<const SocketContext>();
    std::shared_ptr<BoundedLog> log;
    Options options;  // whose log goes there
    const Registry& registry;
    BlobCache cache;
    Machine machine = this_machine();
    std::uint64_t process = process_number();
    HostRights rights;
    HostDoor door;
    PlaceTraffic traffic{door, rights};
    std::shared_ptr<Leadership> leadership = std::make_shared<Leadership>(traffic);
    std::uint64_t broken_packets = 0;
    std::optional<ArrivingJob> arriving;
    LastScene last_scene;
    std::unique_ptr<HostedRun> run;
    std::optional<Gateway> gateway;        // of the run
    std::optional<PeerConnections> peers;  // to the other hosts of the run
    EndedRuns ended;
    std::string who;       // began the run
    std::string launcher;  // route to it
    // Without a word from it for so long, its run is over.
    Lease lease{std::chrono::milliseconds(400), std::chrono::seconds(4), std::chrono::seconds(12)};
    std::uint64_t runs_begun = 0, answered = 0;  // the latter: bundles and tiles of runs that are over
    ShownFigures shown;
    Time needed{};  // last, by anyone

    // Leaving: told to stop, the launcher gives no more work, what was given is answered, it says farewell.
    struct Leaving {
        Time since;
        bool known = false;  // to the launcher
        std::optional<Time> farewell;
        bool for_good = true;  // else it stays, for other runs
    };
    std::optional<Leaving> leaving;
    BackgroundWork background;  // last: what it does looks at the rest

    Service(Options given, const Registry& kinds);
    Options ready(Options wanted) const;
    HostDoor::Options door_options() const;
    bool turn(const std::atomic<bool>& stop);
    void survive(const std::exception& error);
    void arrived(PlaceTraffic::Arrival arrival);
    void damaged(const std::string& route);
    void from_another(const packet::Header& header, Frames frames);
    void control(const PacketSender& sender, const packet::Header& header, const packet::Fields& fields);
    packet::Fields answer_to_ping(const packet::Fields& ping, bool ours);
    void greet(const std::string& route, const packet::Fields& fields);
    void begin(const PacketSender& sender, std::uint64_t id, const packet::Fields& fields);
    void look_at_arriving();
    void start(const ArrivingJob& job, ArrivingJob::Content read);
    void go_on(const std::string& route, const Plan& plan);
    void use(const Plan& plan);
    void drop_owner();
    std::optional<LineKeys> keys_to(const std::string& host) const;
    std::string busy_with() const;
    void tell_needs();
    void tell_state(const PacketSender& sender);
    void take_blob(const std::string& route, std::uint64_t id, const packet::Piece& piece);
    void stop_run(const std::string& route);
    void look_at_ending();
    void tell_failures();
    void refuse(const std::string& route, std::uint64_t id, const std::string& why);
    void end(const std::string& route, std::uint64_t id);
    void drop_run(const std::string& why);
    void advance();
    // Who has something to be read. Looking at an empty socket costs a system call, so only these are looked at.
    struct Readable {
        bool door = false, peers = false, gateway = false;
        bool news = false;     // of the run
        bool replies = false;  // of places and the dispatcher
    };
    Readable wait();
    bool rest(Time now);
    void forward_asks();
    void forward_to_launcher(Frames& frames);
    void show_figures(Time now);
    void tell_left_out(Time now);
    PlaceThreads::SoFar so_far() const;
    void leave(Time now, bool for_good);
    bool gone(Time now);
};

}  // namespace lightnet
