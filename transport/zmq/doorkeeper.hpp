// Who may come in at a door that strangers can reach.
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "transport/zmq/sockets.hpp"

namespace lightnet {

/// Answers for every connection to the doors of one context whether it may be made (ZeroMQ's authentication protocol,
/// RFC 27), and turns those away that would be too many. Made before the doors are bound, used by their thread, and
/// looked after as often as they are: nobody gets in meanwhile.
class Doorkeeper {
public:
    explicit Doorkeeper(zmq::context_t& context);
    ~Doorkeeper();
    Doorkeeper(const Doorkeeper&) = delete;
    Doorkeeper& operator=(const Doorkeeper&) = delete;

    /// This door is in its care from now on. To be called before it is bound.
    void guard(zmq::socket_t& door);
    /// Answers those who wait.
    void tick();
    /// For polling.
    std::vector<zmq::socket_t*> sockets();
    /// Connections to its doors, whether let in or not yet.
    std::size_t peers() const { return peers_.size(); }
    std::size_t turned_away() const { return turned_away_; }

private:
    void note_events(zmq::socket_t& events);
    void answer(Frames& request);
    std::size_t most_now();

    zmq::context_t& context_;
    std::unique_ptr<zmq::socket_t> requests_;
    std::vector<std::unique_ptr<zmq::socket_t>> events_;  // of the doors
    std::set<int> peers_;                                 // descriptors of their connections
    std::size_t turned_away_ = 0, most_ = 0;
    std::chrono::steady_clock::time_point counted_{};
};

/// How many connections a process with so many descriptors left lets in: enough of them stay for its own work.
std::size_t most_peers(std::size_t descriptors_left);

}  // namespace lightnet
