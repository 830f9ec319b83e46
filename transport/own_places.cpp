#include "transport/own_places.hpp"

#include <zmq.hpp>

#include "transport/place_threads.hpp"
#include "transport/way_out.hpp"

namespace lightnet {

struct OwnPlaces::Parts {
    WayOut door;
    PlaceThreads places;
    bool ready = false;
};

OwnPlaces::OwnPlaces(zmq::context_t& context, std::shared_ptr<const Network> network, std::uint64_t run,
                     std::uint32_t count, const Plan& plan, Tuning rules)
    : parts_(new Parts{{context, run}, {context, std::move(network), run, "", count, plan, rules}, false}) {}

OwnPlaces::~OwnPlaces() = default;

std::uint32_t OwnPlaces::count() const { return parts_->places.count(); }

bool OwnPlaces::ready() {
    parts_->places.clear_news();
    return parts_->ready = parts_->places.ready();
}

void OwnPlaces::use(const Plan& plan) {
    if (parts_->ready) parts_->places.use(plan);
}

void OwnPlaces::receive(const Takers& takers) {
    if (!parts_->ready) return;
    while (auto frames = parts_->door.receive()) takers.asked(*frames);
    for (std::uint32_t place = 0; place < count(); ++place)
        while (auto frames = receive_frames(parts_->places.to(place))) {
            if (frames->size() == 1)
                takers.work(take_message(frames->front()));
            else
                takers.answered(*frames);
        }
}

bool OwnPlaces::ask(Message& message, std::uint32_t place) {
    if (!parts_->ready || place >= count()) return false;
    Frames frames;
    frames.push_back(frame_of(std::move(message)));
    if (send_frames(parts_->places.to(place), frames)) return true;
    message = take_message(frames[0]);
    return false;
}

bool OwnPlaces::pass_ask(Frames& frames, std::uint32_t place) {
    return parts_->ready && place < count() && send_frames(parts_->places.to(place), frames);
}

bool OwnPlaces::pass_reply(const std::string& place, Frames& frames) { return parts_->door.pass(place, frames); }

void OwnPlaces::say_again(const std::string& host) { parts_->door.say_again(host); }

std::vector<Failure> OwnPlaces::failures() { return parts_->places.failures(); }

int OwnPlaces::news() const { return parts_->places.news(); }

Counters OwnPlaces::stop() { return parts_->places.stop(); }

std::uint64_t OwnPlaces::progress() const { return parts_->places.progress(); }

std::vector<zmq::socket_t*> OwnPlaces::sockets() {
    std::vector<zmq::socket_t*> sockets{&parts_->door.socket()};
    if (parts_->ready)
        for (std::uint32_t place = 0; place < count(); ++place) sockets.push_back(&parts_->places.to(place));
    return sockets;
}

}  // namespace lightnet
