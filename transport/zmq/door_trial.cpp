#include "transport/zmq/door_trial.hpp"

#include <chrono>

#include "core/base/error.hpp"
#include "core/base/ip_address.hpp"
#include "core/base/patience.hpp"
#include "transport/lines/poll.hpp"
#include "transport/zmq/handshake.hpp"
#include "transport/zmq/socket.hpp"

namespace lightnet {
namespace {

constexpr auto patience = std::chrono::seconds(15);  // a machine that starts many at once is slow

// From where it can be reached on this machine.
std::string knocked_at(const std::string& endpoint) {
    const auto parts = tcp_endpoint(endpoint);
    const auto number = parts ? ip_address(parts->host) : std::nullopt;
    // One for all addresses takes in the old family, too, and a machine may have no other.
    return number && number->is_unspecified() ? TcpEndpoint{"127.0.0.1", parts->port}.text() : endpoint;
}

}  // namespace

// DECISIONS: doors-are-tried
void try_door(const std::string& endpoint, const PublicKey& door, const std::function<void()>& tend) {
    const SocketContext outside;
    auto stranger = unconnected_asking_socket(outside, endpoint, LineKeys{KeyPair::random(), door});
    note_handshakes(outside, stranger);
    stranger.connect(knocked_at(endpoint));
    Patience left(patience);
    while (!left.is_over()) {
        tend();
        if (const auto seen = last_handshake(stranger)) {
            if (*seen == Handshake::refused) return;
            if (*seen == Handshake::made) throw Error(endpoint, "lets strangers in, though it asks for keys: not used");
        }
        Poll poll;
        poll.add(*stranger.events());
        poll.wait(std::chrono::milliseconds(1));
    }
    throw Error(endpoint,
                "has not answered a stranger's key within 15 s, so whether it turns strangers away is not "
                "known: not used (this machine may have too much to do)");
}

}  // namespace lightnet
