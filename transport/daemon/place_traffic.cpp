#include "transport/daemon/place_traffic.hpp"

#include <utility>

#include "transport/wire/packet.hpp"

namespace lightnet {
namespace {

constexpr int most_at_once = 64;  // packets, before a place looks at what is for itself

}  // namespace

void PlaceTraffic::serve(std::uint64_t run, ZmqPlaceTransport* transport) {
    if (run_ != run) given_ = answered_ = 0;
    run_ = run;
    places_ = transport;
}

std::optional<PlaceTraffic::Arrival> PlaceTraffic::next(Time now) {
    if (left_) return std::exchange(left_, std::nullopt);
    auto frames = door_.receive(now);
    if (!frames) return std::nullopt;
    return Arrival{std::move(*frames), door_.key()};
}

std::optional<PlaceTraffic::Arrival> PlaceTraffic::receive(Time now) {
    while (auto arrival = next(now))
        if (!take(*arrival)) return arrival;
    return std::nullopt;
}

bool PlaceTraffic::take_in() {
    const auto now = std::chrono::steady_clock::now();
    int taken = 0;
    while (taken < most_at_once) {
        auto arrival = next(now);
        if (!arrival) break;
        if (!take(*arrival)) return left_ = std::move(arrival), false;
        ++taken;
    }
    if (door_.waiting()) door_.go_on(now);
    return taken > 0;
}

// [route][header][body]
bool PlaceTraffic::take(Arrival& arrival) {
    if (arrival.frames.size() != 3) return false;
    const auto header = packet::peek_header(bytes_of(arrival.frames[1]));
    if (!header || !packet::is_ask(header->type)) return false;
    const bool ours = run_ && header->run == run_;
    if (!rights_.may(arrival.key, header->type, ours)) return false;
    ask(*header, std::move(arrival.frames));
    return true;
}

// Not looked into: the place checks and decodes.
void PlaceTraffic::ask(const packet::Header& header, Frames frames) {
    if (!places_ || header.run != run_) return;
    if (!places_->forward(header.place, frames)) {
        frames.resize(frames.size() - 2);
        frames.emplace_back();
        frames.emplace_back();
        door_.send(frames);  // to be sent again
        return;
    }
    given_ += header.width > 0;
    last_work_ = std::chrono::steady_clock::now();
}

void PlaceTraffic::send() {
    while (auto frames = places_ ? places_->receive() : std::nullopt) {
        if (frames->size() < 3) continue;
        const auto header = packet::peek_header(bytes_of((*frames)[frames->size() - 2]));
        answered_ += !header || header->width > 0;  // as in ask()
        door_.send(*frames);
    }
}

}  // namespace lightnet
