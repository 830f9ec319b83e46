#include "transport/zmq/zmq_place_transport.hpp"

#include <utility>

#include "core/run/message/place_name.hpp"
#include "transport/places/descriptors.hpp"
#include "transport/zmq/zmq_carrier.hpp"

namespace lightnet {
namespace {

// Where it answers, its way to other hosts, ours to it, and the dispatcher's.
constexpr std::size_t sockets_per_place = 4;
constexpr std::size_t other_descriptors = 8;

}  // namespace

ZmqPlaceTransport::ZmqPlaceTransport(std::shared_ptr<const SocketContext> context, std::uint64_t run, std::string host,
                                     std::uint32_t places)
    : context_(std::move(context)), run_(run), host_(std::move(host)) {
    want_descriptors(sockets_per_place * (places + 1) + other_descriptors, std::to_string(places) + " places");
    to_.resize(places + 1);
}

std::unique_ptr<Carrier> ZmqPlaceTransport::carrier_of(std::uint32_t place, AtFault at_fault) {
    return std::make_unique<ZmqCarrier>(*context_, ZmqCarrier::Address{run_, host_, place}, std::move(at_fault));
}

std::unique_ptr<Carrier> ZmqPlaceTransport::asking_carrier() {
    return std::make_unique<ZmqCarrier>(*context_, ZmqCarrier::Address{run_, host_, std::nullopt});
}

std::size_t ZmqPlaceTransport::line_to(std::uint32_t place) const {
    return place == any_place ? to_.size() - 1 : place;
}

// inproc sockets connect only to what is bound: a place that has its carrier is.
Socket& ZmqPlaceTransport::socket_of(std::size_t line) {
    auto& socket = to_[line];
    const auto place = line + 1 < to_.size() ? static_cast<std::uint32_t>(line) : any_place;
    if (!socket) socket.emplace(asking_socket(*context_, inproc_endpoint(run_, place)));
    return *socket;
}

void ZmqPlaceTransport::tell(std::uint32_t place, Message message) {
    auto frames = frames_of(std::move(message));
    socket_of(line_to(place)).send(frames);
}

bool ZmqPlaceTransport::forward(std::uint32_t place, Frames& frames) {
    const auto line = line_to(place);
    const bool is_there = place == any_place || line + 1 < to_.size();
    return is_there && socket_of(line).send(frames);
}

std::optional<Frames> ZmqPlaceTransport::receive(std::size_t line) { return socket_of(line).receive(); }

void ZmqPlaceTransport::watch(Poll& poll) {
    for (std::size_t line = 0; line < to_.size(); ++line) poll.add(socket_of(line));
}

std::unique_ptr<PlaceTransport> zmq_within_process(std::uint64_t run, std::uint32_t places) {
    // inproc needs no thread of ZeroMQ's own
    return std::make_unique<ZmqPlaceTransport>(std::make_shared<const SocketContext>(0), run, "", places);
}

}  // namespace lightnet
