#include "transport/zmq/zmq_place_transport.hpp"

#include <utility>

#include "core/run/message/place_name.hpp"
#include "transport/places/descriptors.hpp"
#include "transport/zmq/zmq_carrier.hpp"

namespace lightnet {
namespace {

// Where it answers, its way to other hosts, the dispatcher's to it, and its queue.
constexpr std::size_t descriptors_per_place = 4;
constexpr std::size_t other_descriptors = 8;

}  // namespace

ZmqPlaceTransport::ZmqPlaceTransport(std::shared_ptr<const SocketContext> context, std::uint64_t run, std::string host,
                                     std::uint32_t places, ShortWays ways)
    : context_(std::move(context)), run_(run), host_(std::move(host)), ways_(std::move(ways)) {
    want_descriptors(descriptors_per_place * (places + 1) + other_descriptors, std::to_string(places) + " places");
    for (std::uint32_t i = 0; i <= places; ++i) to_.push_back(std::make_shared<FrameQueue>());
}

std::unique_ptr<Carrier> ZmqPlaceTransport::carrier_of(std::uint32_t place, AtFault at_fault) {
    const bool is_place = place != any_place;  // the dispatcher idles nearly always, and nothing is for itself
    const ZmqCarrier::Queues queues{to_[is_place ? place : to_.size() - 1], replies_, ways_.door, is_place};
    return std::make_unique<ZmqCarrier>(*context_, ZmqCarrier::Address{run_, host_, place, queues}, std::move(at_fault),
                                        ways_.lines);
}

std::unique_ptr<Carrier> ZmqPlaceTransport::asking_carrier() {
    return std::make_unique<ZmqCarrier>(*context_, ZmqCarrier::Address{run_, host_, std::nullopt});
}

FrameQueue* ZmqPlaceTransport::queue_to(std::uint32_t place) {
    if (place == any_place) return to_.back().get();
    return place + 1 < to_.size() ? to_[place].get() : nullptr;
}

void ZmqPlaceTransport::tell(std::uint32_t place, Message message) {
    auto frames = frames_of(std::move(message));
    if (auto* const queue = queue_to(place)) queue->push_always(frames);
}

bool ZmqPlaceTransport::forward(std::uint32_t place, Frames& frames) {
    auto* const queue = queue_to(place);
    return queue && queue->push(frames);
}

std::unique_ptr<PlaceTransport> zmq_within_process(std::uint64_t run, std::uint32_t places) {
    // inproc needs no thread of ZeroMQ's own
    return std::make_unique<ZmqPlaceTransport>(std::make_shared<const SocketContext>(0), run, "", places);
}

}  // namespace lightnet
