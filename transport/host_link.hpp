// One host, as the launcher sees it.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/hash.hpp"
#include "core/runtime/counters.hpp"
#include "core/runtime/message.hpp"
#include "core/scene/files.hpp"
#include "transport/packet.hpp"

namespace zmq {
class context_t;
class socket_t;
}  // namespace zmq

namespace lightnet {

/// What every link of a run shares: what hosts are told. Outlives the links.
struct Told {
    std::uint64_t run = 0;
    std::string isa;
    std::uint64_t fingerprint = 0;
    std::string job;  // as text
    std::map<Hash, Bytes> blobs;
};

/// Greets a host, sends it the job and the files that it lacks, waits until its places are ready, and keeps its lease:
/// a host that does not answer three heartbeats in a row is lost, and greeted anew. Time is an argument.
class HostLink {
public:
    using Time = std::chrono::steady_clock::time_point;
    enum class State { calling, greeted, sending, building, ready, refused };

    /// Counts what it sends and receives in `counters`, which must outlive it.
    HostLink(zmq::context_t& context, const Told& told, Counters& counters, std::string endpoint);
    ~HostLink();

    const std::string& endpoint() const { return endpoint_; }
    State state() const { return state_; }
    std::uint32_t places() const { return places_; }
    /// Why it is refused, or what it waits for.
    const std::string& reason() const { return reason_; }
    /// It can't build the job: the run is at fault, not the host.
    bool broken() const { return broken_; }
    /// Its counters, once it has ended the run.
    const std::optional<Counters>& ended() const { return ended_; }

    /// Sends what is due. `plan` gives the plan that is to be expected, as text; it is called when it is needed.
    void tick(Time now, const std::function<std::string()>& plan);
    /// Takes one message from the host, if there is one, and gives it on if it is work: then `.second`. `.first`:
    /// anything came.
    std::pair<bool, std::optional<Message>> receive(Time now);
    bool send(Message& message, std::uint32_t place);
    void send_plan(const std::string& plan);
    /// Sees to it that the host has these bytes. True when it has said so.
    bool bring(const Hash& name, const Bytes& bytes);
    void send_end();
    /// The host is gone; calls it again.
    void lose(Time now, const std::string& why);
    /// For polling.
    std::vector<zmq::socket_t*> sockets();

private:
    bool send(packet::Type type, const packet::Fields& fields);
    void control(packet::Type type, const packet::Fields& fields, Time now);
    void welcome(const packet::Fields& fields);
    void queue_blobs(const std::string& hashes);
    void queue_blob(const Hash& hash);
    Bytes blob(const Hash& hash) const;
    void send_blobs();
    void heartbeat(Time now);

    zmq::context_t& context_;
    const Told& told_;
    Counters& counters_;
    std::string endpoint_;
    std::unique_ptr<zmq::socket_t> lane_, bulk_;  // work and control; files
    State state_ = State::calling;
    std::string reason_;
    bool broken_ = false;
    std::uint32_t places_ = 0;
    std::uint64_t incarnation_ = 0;
    Time heard_{}, next_call_{}, next_ping_{};
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
};

}  // namespace lightnet
