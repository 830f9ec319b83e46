#include "transport/launcher/relays.hpp"

#include <utility>
#include <zmq.hpp>

namespace lightnet {
namespace {

using packet::Type;

constexpr auto again_interval = std::chrono::milliseconds(100);

}  // namespace

void Relays::pass_on(const std::string& from, Frames& frames) {
    const auto address = unseal(bytes_of(frames[0]));
    const auto header = packet::peek_header(bytes_of(frames[1]));
    if (address && frames[1].size() == 0) return must_say_again(address->host);  // its ask arrived damaged
    if (!address) ways_.damaged();
    if (!address || !header || header->type >= Type::hello) {
        ++counters_.broken_packets;
        return must_say_again(from);
    }
    counters_.relayed_bytes += frames[1].size() + frames[2].size();
    if (packet::is_reply(header->type)) {
        if (!ways_.reply(*address, frames)) must_say_again(address->host);
        return;
    }
    frames[0] = frame_of(seal({from, address->place}));
    if (!ways_.ask(address->host, frames, header->place)) must_say_again(from);
}

void Relays::say_again(Time now) {
    if (to_say_again_.empty() || now < next_again_) return;
    next_again_ = now + again_interval;
    for (const auto& host : std::exchange(to_say_again_, {})) ways_.say_again(host);
}

}  // namespace lightnet
