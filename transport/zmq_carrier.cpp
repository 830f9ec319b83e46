#include "transport/zmq_carrier.hpp"

#include <algorithm>
#include <map>
#include <vector>
#include <zmq.hpp>

#include "transport/sockets.hpp"

namespace lightnet {
namespace {

// An ask that came as a packet, through the door of the host: route of the door, then of the asker.
constexpr std::size_t hops_of_packet = 2;

}  // namespace

std::string inproc_endpoint(std::uint64_t run, std::uint32_t place) {
    return "inproc://run-" + std::to_string(run) + "/place-" + std::to_string(place);
}

struct ZmqCarrier::Sockets {
    // Looking into an empty socket costs a call of the system. So each is looked into until it is dry, and then not
    // again before all are, or before wait() has found something in it.
    struct Source {
        zmq::socket_t socket;
        bool dry = false;
    };

    zmq::context_t& context;
    Ends ends;
    std::optional<Source> answering;
    std::map<std::string, Source> asking;  // by endpoint
    Counters counters;
    std::size_t next = 0;  // fair turns among the asking sockets

    std::vector<Source*> all() {
        std::vector<Source*> sources;
        if (answering) sources.push_back(&*answering);
        for (auto& [endpoint, source] : asking) sources.push_back(&source);
        return sources;
    }

    std::string endpoint_of(const PlaceAt& place) const {
        return place.host == ends.host ? inproc_endpoint(ends.run, place.index) : place.host;
    }

    zmq::socket_t& to(const std::string& endpoint) {
        const auto found = asking.find(endpoint);
        if (found != asking.end()) return found->second.socket;
        return asking.emplace(endpoint, Source{asking_socket(context, endpoint)}).first->second.socket;
    }

    std::optional<Message> from_packet(const Frames& frames, std::size_t first) {
        auto message = packet::unpack(bytes_of(frames[first]), bytes_of(frames[first + 1]));
        if (!message) ++counters.broken_packets;
        counters.bytes += frames[first].size() + frames[first + 1].size();
        return message;
    }

    std::optional<Message> from_asker(Frames frames) {
        if (frames.size() == 2) {  // route, pointer
            auto message = take_message(frames[1]);
            message.route.hops = {text_of(frames[0])};
            return message;
        }
        if (frames.size() != hops_of_packet + 2) return std::nullopt;
        auto message = from_packet(frames, hops_of_packet);
        if (message) message->route.hops = {text_of(frames[0]), text_of(frames[1])};
        return message;
    }

    std::optional<Message> from_answerer(Frames frames) {
        if (frames.size() == 1) return take_message(frames[0]);
        if (frames.size() != 2) return std::nullopt;
        return from_packet(frames, 0);
    }
};

ZmqCarrier::ZmqCarrier(zmq::context_t& context, Ends ends)
    : sockets_(new Sockets{context, std::move(ends), std::nullopt, {}, {}, 0}) {
    if (!sockets_->ends.answers) return;
    sockets_->answering.emplace(Sockets::Source{answering_socket(context)});
    sockets_->answering->socket.bind(inproc_endpoint(sockets_->ends.run, sockets_->ends.place));
}

ZmqCarrier::~ZmqCarrier() = default;

bool ZmqCarrier::ask(const PlaceAt& to, Message& message) {
    auto& socket = sockets_->to(sockets_->endpoint_of(to));
    Frames frames;
    const bool here = to.host == sockets_->ends.host;
    if (here)
        frames.push_back(frame_of(std::move(message)));
    else
        append(frames, packet::pack(message, to.index));
    std::size_t size = 0;
    for (const auto& frame : frames) size += frame.size();
    if (send_frames(socket, frames)) {
        if (!here) sockets_->counters.bytes += size;
        return true;
    }
    ++sockets_->counters.refused_sends;
    if (here) message = take_message(frames[0]);
    return false;
}

void ZmqCarrier::reply(Message message) {
    Frames frames;
    for (const auto& hop : message.route.hops) frames.push_back(frame_of(hop));
    if (message.route.hops.size() == hops_of_packet) {
        append(frames, packet::pack(message, 0));
        sockets_->counters.bytes += frames[2].size() + frames[3].size();
    } else {
        frames.push_back(frame_of(std::move(message)));
    }
    if (!send_frames(sockets_->answering->socket, frames)) ++sockets_->counters.refused_sends;
}

std::optional<Message> ZmqCarrier::receive() {
    auto& s = *sockets_;
    const auto take = [](Sockets::Source& source, const auto& read) -> std::optional<Message> {
        while (!source.dry) {
            auto frames = receive_frames(source.socket);
            if (!frames)
                source.dry = true;
            else if (auto message = read(std::move(*frames)))
                return message;
        }
        return std::nullopt;
    };
    if (s.answering)
        if (auto message = take(*s.answering, [&](Frames frames) { return s.from_asker(std::move(frames)); }))
            return message;
    for (std::size_t turn = 0; turn < s.asking.size(); ++turn) {
        auto source = s.asking.begin();
        std::advance(source, static_cast<std::ptrdiff_t>(s.next++ % s.asking.size()));
        if (auto message = take(source->second, [&](Frames frames) { return s.from_answerer(std::move(frames)); }))
            return message;
    }
    for (auto* source : s.all()) source->dry = false;
    return std::nullopt;
}

void ZmqCarrier::wait(std::chrono::nanoseconds most) {
    const auto sources = sockets_->all();
    std::vector<zmq::pollitem_t> items;
    for (auto* source : sources) items.push_back({source->socket.handle(), 0, ZMQ_POLLIN, 0});
    const auto ms = std::chrono::ceil<std::chrono::milliseconds>(most);
    try {
        zmq::poll(items, std::max(ms, std::chrono::milliseconds(1)));
    } catch (const zmq::error_t& error) {
        if (error.num() != EINTR) throw;
    }
    for (std::size_t i = 0; i < items.size(); ++i) sources[i]->dry = !(items[i].revents & ZMQ_POLLIN);
}

void ZmqCarrier::forget(const PlaceAt& place) { sockets_->asking.erase(sockets_->endpoint_of(place)); }

const Counters& ZmqCarrier::counters() const { return sockets_->counters; }

}  // namespace lightnet
