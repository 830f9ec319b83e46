// Who may come in at a door that strangers can reach.
#pragma once

#include <chrono>
#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include "transport/zmq/poll.hpp"
#include "transport/zmq/socket.hpp"

namespace lightnet {

/// Admission control: answers for every connection to the doors of one context whether it may be made (ZeroMQ's
/// authentication protocol, RFC 27), and turns those away that would be too many. Made before the doors are bound, used
/// by their thread, and looked after as often as they are: nobody gets in meanwhile.
class Doorkeeper {
public:
    explicit Doorkeeper(const SocketContext& context);
    Doorkeeper(const Doorkeeper&) = delete;
    Doorkeeper& operator=(const Doorkeeper&) = delete;

    /// This door is in its care from now on. To be called before it is bound.
    void guard(Socket& door);
    /// Answers those who wait.
    void tick();
    void watch(Poll& poll) const;
    /// Connections to its doors, whether let in or not yet.
    std::size_t peers() const { return peers_.size(); }
    std::size_t turned_away() const { return turned_away_; }

private:
    void note_events(Socket& events);
    void answer(Frames& request);
    std::size_t most_now();

    const SocketContext& context_;
    Socket requests_;
    std::vector<Socket> events_;  // of the doors
    std::set<int> peers_;         // descriptors of their connections
    std::size_t turned_away_ = 0, most_ = 0;
    std::chrono::steady_clock::time_point counted_{};
};

/// How many connections a process with so many descriptors left lets in: enough of them stay for its own work.
std::size_t most_peers(std::size_t descriptors_left);

}  // namespace lightnet
