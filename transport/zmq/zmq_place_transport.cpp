#include "transport/zmq/zmq_place_transport.hpp"

#include <utility>

#include "transport/places/descriptors.hpp"
#include "transport/zmq/zmq_carrier.hpp"

namespace lightnet {
namespace {

constexpr std::size_t sockets_per_place = 3;  // where it answers, its way to other hosts, and ours to it
constexpr std::size_t other_descriptors = 8;

}  // namespace

ZmqPlaceTransport::ZmqPlaceTransport(std::shared_ptr<const SocketContext> context, std::uint64_t run, std::string host,
                                     std::uint32_t places)
    : context_(std::move(context)), run_(run), host_(std::move(host)) {
    want_descriptors(sockets_per_place * places + other_descriptors, std::to_string(places) + " places");
    to_.resize(places);
}

std::unique_ptr<Carrier> ZmqPlaceTransport::carrier_of(std::uint32_t place, AtFault at_fault) {
    return std::make_unique<ZmqCarrier>(*context_, ZmqCarrier::Address{run_, host_, place}, std::move(at_fault));
}

std::unique_ptr<Carrier> ZmqPlaceTransport::asking_carrier() {
    return std::make_unique<ZmqCarrier>(*context_, ZmqCarrier::Address{run_, host_, std::nullopt});
}

// inproc sockets connect only to what is bound: a place that has its carrier is.
Socket& ZmqPlaceTransport::socket_to(std::uint32_t place) {
    auto& socket = to_[place];
    if (!socket) socket.emplace(asking_socket(*context_, inproc_endpoint(run_, place)));
    return *socket;
}

void ZmqPlaceTransport::tell(std::uint32_t place, Message message) {
    auto frames = frames_of(std::move(message));
    socket_to(place).send(frames);
}

bool ZmqPlaceTransport::forward(std::uint32_t place, Frames& frames) {
    return place < to_.size() && socket_to(place).send(frames);
}

std::optional<Frames> ZmqPlaceTransport::receive(std::uint32_t place) { return socket_to(place).receive(); }

void ZmqPlaceTransport::watch(Poll& poll) {
    for (std::uint32_t place = 0; place < to_.size(); ++place) poll.add(socket_to(place));
}

std::unique_ptr<PlaceTransport> zmq_within_process(std::uint64_t run, std::uint32_t places) {
    // inproc needs no thread of ZeroMQ's own
    return std::make_unique<ZmqPlaceTransport>(std::make_shared<const SocketContext>(0), run, "", places);
}

}  // namespace lightnet
