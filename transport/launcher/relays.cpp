#include "transport/launcher/relays.hpp"

#include <utility>

namespace lightnet {
namespace {

using packet::Type;

constexpr auto request_interval = std::chrono::milliseconds(100);

}  // namespace

// DECISIONS: relays-are-tagged
std::string Relays::tag_text(const std::string& asker, const std::string& place, const std::string& answerer,
                             const packet::Header& header) const {
    std::string text;
    for (const auto& part : {asker, place, answerer}) text += std::to_string(part.size()) + ":" + part;
    for (const auto number : {header.run, header.bundle, std::uint64_t{header.channel}})
        text += std::to_string(number) + ",";
    return text;
}

void Relays::forward(const std::string& from, Frames& frames) {
    const auto address = unseal(bytes_of(frames[0]));
    const auto header = packet::peek_header(bytes_of(frames[1]));
    if (address && frames[1].size() == 0) return must_resend(address->host);  // its ask arrived damaged
    if (!address) handlers_.damaged();
    if (!address || !header || header->type >= Type::hello) {
        ++counters_.broken_packets;
        return must_resend(from);
    }
    counters_.relayed_bytes += frames[1].size() + frames[2].size();
    if (packet::is_reply(header->type)) {
        if (!mac_.fits(tag_text(address->host, address->place, from, *header), address->tag)) {
            ++counters_.broken_packets;
            return;
        }
        if (!handlers_.reply(*address, frames)) must_resend(address->host);
        return;
    }
    frames[0] =
        MessageFrame(seal({from, address->place, mac_.tag(tag_text(from, address->place, address->host, *header))}));
    if (!handlers_.ask(address->host, frames, header->place)) must_resend(from);
}

void Relays::request_resends(Time now) {
    if (to_resend_.empty() || now < next_request_) return;
    next_request_ = now + request_interval;
    for (const auto& host : std::exchange(to_resend_, {})) handlers_.request_resend(host);
}

}  // namespace lightnet
