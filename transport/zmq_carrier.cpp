#include "transport/zmq_carrier.hpp"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>
#include <zmq.hpp>

#include "transport/relay.hpp"
#include "transport/sockets.hpp"

namespace lightnet {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto unreachable_after = std::chrono::seconds(1);  // then the launcher passes on what is for that host
constexpr auto look_interval = std::chrono::milliseconds(200);
// After so long without any answer a host is asked again: a flipped bit can make a message vanish without a trace. The
// next time it is given twice as long, since it may just be slow.
constexpr auto shortest_patience = std::chrono::milliseconds(3000);

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
        bool greeted = false;  // doors greet each connection with an empty message: the first is expected
    };
    // Another host.
    struct Peer {
        bool relayed = false;  // its door can't be reached from here
        bool may_be_called = false;
        std::optional<Clock::time_point> unreachable;  // since when
        Clock::time_point asked{}, answered{};         // last
        std::chrono::milliseconds patience = shortest_patience;
    };
    // A packet whose reply is not there yet.
    struct Pending {
        std::string host;
        zmq::message_t header, body;
        bool sent = true;
    };

    zmq::context_t& context;
    Ends ends;
    std::optional<Source> answering;
    std::map<std::string, Source> asking;  // by endpoint
    Counters counters;
    std::size_t next = 0;  // fair turns among the asking sockets
    std::map<std::string, Peer> peers;
    std::map<std::pair<std::uint32_t, std::uint64_t>, Pending> pending;  // by channel and bundle
    std::size_t asked_here = 0;                                          // of places of this host, and not answered
    bool unsent = false;                                                 // some of them are to be sent again
    Clock::time_point looked{};

    std::vector<Source*> all() {
        std::vector<Source*> sources;
        if (answering) sources.push_back(&*answering);
        for (auto& [endpoint, source] : asking) sources.push_back(&source);
        return sources;
    }

    zmq::socket_t& to(const std::string& endpoint) {
        const auto found = asking.find(endpoint);
        if (found != asking.end()) return found->second.socket;
        return asking.emplace(endpoint, Source{asking_socket(context, endpoint)}).first->second.socket;
    }

    Peer& peer(const std::string& host) {
        const auto [found, fresh] = peers.try_emplace(host);
        if (fresh) {
            found->second.may_be_called = calls_directly(ends.host, host);
            found->second.relayed = !found->second.may_be_called;
        }
        return found->second;
    }

    // Sends a packet by the way that its host has now.
    bool send(Pending& packet) {
        auto& way = peer(packet.host);
        Frames frames;
        if (way.relayed) frames.push_back(frame_of(packet.host));
        for (auto* frame : {&packet.header, &packet.body}) frames.emplace_back().copy(*frame);
        if (send_frames(to(way.relayed ? relay_endpoint(ends.run) : packet.host), frames)) {
            way.unreachable.reset();
            way.asked = Clock::now();
            counters.bytes += packet.header.size() + packet.body.size();
            return true;
        }
        if (!way.relayed) cannot_be_reached(packet.host, way);
        return false;
    }

    // A host that can't be called for a while is asked through the launcher, until it can be.
    void cannot_be_reached(const std::string& host, Peer& way) {
        const auto now = Clock::now();
        if (!way.unreachable) way.unreachable = now;
        if (now - *way.unreachable < unreachable_after) return;
        way.relayed = true;
        say_again([&](const Pending& packet) { return packet.host == host; });
    }

    template <class Which>
    void say_again(const Which& which) {
        for (auto& [key, packet] : pending)
            if (which(packet)) packet.sent = false, unsent = true;
    }

    // What was under way on this connection may be lost.
    void connected_anew(const std::string& endpoint) {
        if (endpoint == relay_endpoint(ends.run))
            return say_again([&](const Pending& packet) { return peer(packet.host).relayed; });
        auto& way = peer(endpoint);
        way.relayed = false;
        way.unreachable.reset();
        say_again([&](const Pending& packet) { return packet.host == endpoint; });
    }

    void look_after_pending() {
        const auto now = Clock::now();
        if (!unsent && now - looked < look_interval) return;
        if (now - looked >= look_interval) {
            looked = now;
            for (auto& [host, way] : peers) {
                if (now - std::max(way.asked, way.answered) > way.patience && has_pending(host)) {
                    way.patience *= 2;
                    // clang 14 captures no binding by itself
                    say_again([&host = host](const Pending& packet) { return packet.host == host; });
                }
                const auto source = asking.find(host);
                if (way.relayed || source == asking.end()) continue;
                if (source->second.socket.get(zmq::sockopt::events) & ZMQ_POLLOUT)
                    way.unreachable.reset();
                else if (has_pending(host))
                    cannot_be_reached(host, way);
            }
        }
        if (!std::exchange(unsent, false)) return;
        for (auto& [key, packet] : pending)
            if (!packet.sent) packet.sent = send(packet), unsent |= !packet.sent;
    }

    bool has_pending(const std::string& host) const {
        return std::any_of(pending.begin(), pending.end(), [&](const auto& one) { return one.second.host == host; });
    }

    void settle(const std::pair<std::uint32_t, std::uint64_t>& key) {
        const auto found = pending.find(key);
        if (found == pending.end()) return;
        auto& way = peer(found->second.host);
        way.answered = Clock::now();
        way.patience = shortest_patience;
        pending.erase(found);
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
        if (frames.size() < 4) return std::nullopt;
        const std::size_t hops = frames.size() - 2;
        auto message = from_packet(frames, hops);
        if (message) {
            for (std::size_t i = 0; i < hops; ++i) message->route.hops.push_back(text_of(frames[i]));
            return message;
        }
        for (std::size_t i = hops; i < frames.size(); ++i) frames[i].rebuild();  // the asker must say it again
        send_frames(answering->socket, frames);
        return std::nullopt;
    }

    std::optional<Message> from_answerer(const std::string& endpoint, Frames frames) {
        if (is_empty(frames)) {
            const bool expected = !std::exchange(asking.at(endpoint).greeted, true);
            if (endpoint == relay_endpoint(ends.run) || !expected || peer(endpoint).relayed) connected_anew(endpoint);
            return std::nullopt;
        }
        const bool by_pointer = endpoint.starts_with("inproc://") && endpoint != relay_endpoint(ends.run);
        if (by_pointer) {
            asked_here -= asked_here > 0;
            return take_message(frames[0]);
        }
        auto message = frames.size() == 2 ? from_packet(frames, 0) : std::nullopt;  // a flipped bit splits messages
        if (message)
            settle({message->channel, message->bundle});
        else
            connected_anew(endpoint);
        return message;
    }
};

ZmqCarrier::ZmqCarrier(zmq::context_t& context, Ends ends)
    : sockets_(new Sockets{context, std::move(ends), std::nullopt, {}, {}, 0, {}, {}, 0, false, {}}) {
    if (!sockets_->ends.answers) return;
    sockets_->answering.emplace(Sockets::Source{answering_socket(context)});
    sockets_->answering->socket.bind(inproc_endpoint(sockets_->ends.run, sockets_->ends.place));
}

ZmqCarrier::~ZmqCarrier() = default;

bool ZmqCarrier::ask(const PlaceAt& to, Message& message) {
    auto& s = *sockets_;
    if (to.host == s.ends.host) {
        Frames frames;
        frames.push_back(frame_of(std::move(message)));
        if (send_frames(s.to(inproc_endpoint(s.ends.run, to.index)), frames)) {
            ++s.asked_here;
            return true;
        }
        message = take_message(frames[0]);
        if (!may_be_full(s.asked_here)) return false;  // it has ended
    } else {
        auto packet = packet::pack(message, to.index);
        Sockets::Pending kept{to.host, frame_of(std::move(packet.header)), frame_of(std::move(packet.body)), true};
        if (s.send(kept)) {
            s.pending.insert_or_assign({message.channel, message.bundle}, std::move(kept));
            return true;
        }
        if (!may_be_full(s.pending.size())) return false;  // not connected yet, or cut for the moment
    }
    ++s.counters.refused_sends;
    return false;
}

void ZmqCarrier::reply(Message message) {
    Frames frames;
    for (const auto& hop : message.route.hops) frames.push_back(frame_of(hop));
    if (frames.size() > 1) {
        append(frames, packet::pack(message, 0));
        for (std::size_t i = message.route.hops.size(); i < frames.size(); ++i)
            sockets_->counters.bytes += frames[i].size();
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
        const auto read = [&](Frames frames) { return s.from_answerer(source->first, std::move(frames)); };
        if (auto message = take(source->second, read)) return message;
    }
    for (auto* source : s.all()) source->dry = false;
    if (!s.pending.empty()) s.look_after_pending();
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

void ZmqCarrier::give_up(std::uint32_t channel) {
    std::erase_if(sockets_->pending, [&](const auto& one) { return one.first.first == channel; });
}

void ZmqCarrier::forget(const PlaceAt& place) {
    // Other nodes of that host may still be asked; its socket goes with the last of them. Places of this process share
    // its end.
    if (place.host == sockets_->ends.host || sockets_->has_pending(place.host)) return;
    sockets_->asking.erase(place.host);
    sockets_->peers.erase(place.host);
}

const Counters& ZmqCarrier::counters() const { return sockets_->counters; }

}  // namespace lightnet
