#include "transport/zmq/doorkeeper.hpp"

#include <zmq.h>
#include <algorithm>
#include <atomic>
#include <cstring>
#include <utility>

#include "transport/places/descriptors.hpp"

namespace lightnet {
namespace {

// DECISIONS: guarded-port
constexpr const char* authentication = "inproc://zeromq.zap.01";  // the name is ZeroMQ's
constexpr int enforce_domain = 93;  // ZMQ_ZAP_ENFORCE_DOMAIN: without a doorkeeper nobody gets in; not in all headers
constexpr std::size_t for_own_work = 64, most_let_in = 4096, least_let_in = 8;

std::string events_endpoint() {
    static std::atomic<unsigned> number{0};
    return "inproc://door-events-" + std::to_string(number++);
}

}  // namespace

std::size_t most_peers(std::size_t left) {
    return std::clamp(left > for_own_work ? (left - for_own_work) / 2 : 0, least_let_in, most_let_in);
}

Doorkeeper::Doorkeeper(const SocketContext& context) : context_(context), requests_(context, ZMQ_REP) {
    requests_.bind(authentication);
}

void Doorkeeper::guard(Socket& door) {
    door.set(ZMQ_ZAP_DOMAIN, "lightnet");
    const int on = 1;
    zmq_setsockopt(door.library(), enforce_domain, &on, sizeof on);  // older libraries don't know it
    const auto endpoint = events_endpoint();
    if (zmq_socket_monitor(door.library(), endpoint.c_str(), ZMQ_EVENT_ACCEPTED | ZMQ_EVENT_DISCONNECTED) != 0)
        throw SocketError();
    events_.emplace_back(context_, ZMQ_PAIR).connect(endpoint);
}

void Doorkeeper::watch(Poll& poll) const {
    poll.add(requests_);
    for (const auto& events : events_) poll.add(events);
}

void Doorkeeper::tick() {
    for (auto& events : events_) note_events(events);
    while (auto request = requests_.receive()) answer(*request);
}

// An event is two frames: a number of 16 bits and a value of 32, then the address.
void Doorkeeper::note_events(Socket& events) {
    while (auto frames = events.receive()) {
        std::uint16_t event = 0;
        std::int32_t descriptor = 0;
        if (frames->front().size() < sizeof event + sizeof descriptor) continue;
        std::memcpy(&event, frames->front().data(), sizeof event);
        std::memcpy(&descriptor, static_cast<const char*>(frames->front().data()) + sizeof event, sizeof descriptor);
        if (event == ZMQ_EVENT_ACCEPTED)
            peers_.insert(descriptor);
        else
            peers_.erase(descriptor);
    }
}

// Looking at all descriptors takes time, and connections may come in floods.
std::size_t Doorkeeper::most_now() {
    const auto now = std::chrono::steady_clock::now();
    if (now - counted_ > std::chrono::seconds(1)) {
        most_ = most_peers(descriptors_left() + peers_.size());
        counted_ = now;
    }
    return most_;
}

// [version][request][domain][address][identity][mechanism]… → [version][request][code][text][user][metadata]
void Doorkeeper::answer(Frames& request) {
    const bool sound = request.size() >= 6 && text_of(request[0]) == "1.0";
    const bool room = peers_.size() <= most_now();
    turned_away_ += !room;
    Frames reply;
    reply.emplace_back("1.0");
    reply.push_back(sound ? std::move(request[1]) : MessageFrame());
    reply.emplace_back(sound && room ? "200" : "400");
    reply.emplace_back(room ? "" : "too many connections");
    reply.emplace_back("");
    reply.emplace_back("");
    requests_.send(reply);
}

}  // namespace lightnet
