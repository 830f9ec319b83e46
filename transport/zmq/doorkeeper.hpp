// The doorkeeper of a port that strangers can reach.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "transport/keys/key.hpp"
#include "transport/lines/poll.hpp"
#include "transport/zmq/socket.hpp"

namespace lightnet {

/// Admission control: answers for every connection to the doors of one context whether it may be made (ZeroMQ's
/// authentication protocol, RFC 27), and turns those away that would be too many or whose key is not known. What comes
/// in then bears the key of its sender (see PeerName). Made before the doors are bound, used by their
/// thread, and looked after as often as they are: nobody gets in meanwhile.
class Doorkeeper {
public:
    using Keys = DoorKeys;
    /// Without `keys`: everybody, as long as there is room.
    explicit Doorkeeper(const SocketContext& context, std::optional<Keys> keys = std::nullopt);
    Doorkeeper(const Doorkeeper&) = delete;
    Doorkeeper& operator=(const Doorkeeper&) = delete;

    /// This door is in its care from now on. It stays where it is, and outlives all use of this but its end. To be
    /// called before it is bound. Throws Error when the library is too old to be trusted with keys.
    void guard(Socket& door);
    /// After it was bound: sees that no stranger gets in. Throws Error when one does.
    void try_out(const Socket& door);
    /// Answers those who wait.
    void tick();
    void watch(Poll& poll) const;
    /// Connections to its doors, whether let in or not yet.
    std::size_t peers() const { return peers_.size(); }
    std::size_t turned_away() const { return turned_away_; }

private:
    void count_peers(Socket& door);
    void answer(Frames& request);
    const char* verdict(const Frames& request, std::string& who);
    std::size_t most_now();

    const SocketContext& context_;
    std::optional<Keys> keys_;
    Socket requests_;
    std::vector<Socket*> doors_;
    std::set<int> peers_;  // descriptors of their connections
    std::size_t turned_away_ = 0, most_ = 0;
    bool on_trial_ = false;
    std::chrono::steady_clock::time_point counted_{};
};

/// How many connections a process with so many descriptors left lets in: enough of them stay for its own work.
std::size_t most_peers(std::size_t descriptors_left);

}  // namespace lightnet
