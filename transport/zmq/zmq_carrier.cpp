#include "transport/zmq/zmq_carrier.hpp"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "transport/zmq/gateway.hpp"
#include "transport/zmq/poll.hpp"

namespace lightnet {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto socket_look_interval = std::chrono::milliseconds(200);
// After so long without any answer packets are sent again: a flipped bit can make a message vanish without a trace. The
// next time the host is given twice as long (exponential backoff), since it may just be slow.
// DECISIONS: say-it-again
constexpr auto shortest_patience = std::chrono::milliseconds(3000);

}  // namespace

std::string inproc_endpoint(std::uint64_t run, std::uint32_t place) {
    return "inproc://run-" + std::to_string(run) + "/place-" + std::to_string(place);
}

struct ZmqCarrier::Sockets {
    // Looking into an empty socket costs a call of the system, and so does looking at all of them at once. So each is
    // looked into until it is dry, and at all of them when all are.
    struct Source {
        Socket socket;
        bool dry = false;
    };
    // Another host.
    struct Peer {
        Clock::time_point asked{}, answered{};  // last
        std::chrono::milliseconds patience = shortest_patience;
    };
    // A packet whose reply is not there yet.
    struct Pending {
        std::string host;
        MessageFrame header, body;
        bool sent = true;
    };

    const SocketContext& context;
    Address me;
    PlaceTransport::AtFault at_fault;
    std::optional<Source> answering{};
    std::map<std::string, Source> asking{};  // by endpoint
    Counters counters{};
    std::size_t next = 0;  // fair turns among the asking sockets
    std::map<std::string, Peer> peers{};
    std::map<std::pair<std::uint32_t, std::uint64_t>, Pending> pending{};  // by channel and bundle
    std::size_t asked_here = 0;                                            // of places of this host, and not answered
    bool unsent = false;                                                   // some of them are to be sent again
    Clock::time_point looked{};

    std::vector<Source*> all() {
        std::vector<Source*> sources;
        if (answering) sources.push_back(&*answering);
        for (auto& [endpoint, source] : asking) sources.push_back(&source);
        return sources;
    }

    bool all_dry() const {
        return (!answering || answering->dry) &&
               std::ranges::all_of(asking, [](const auto& source) { return source.second.dry; });
    }

    void look(std::chrono::milliseconds most) {
        const auto sources = all();
        Poll poll;
        for (const auto* source : sources) poll.add(source->socket);
        poll.wait(most);
        for (std::size_t i = 0; i < sources.size(); ++i) sources[i]->dry = !poll.readable(i);
    }

    Socket& to(const std::string& endpoint) {
        const auto found = asking.find(endpoint);
        if (found != asking.end()) return found->second.socket;
        return asking.emplace(endpoint, Source{asking_socket(context, endpoint)}).first->second.socket;
    }

    // Hands a packet to the gateway of this process.
    bool send(Pending& packet) {
        Frames frames;
        frames.emplace_back(packet.host);
        for (auto* frame : {&packet.header, &packet.body}) frames.push_back(frame->shared());
        if (!to(gateway_endpoint(me.run)).send(frames)) return false;
        peers[packet.host].asked = Clock::now();
        counters.bytes += packet.header.size() + packet.body.size();
        return true;
    }

    // What was under way to a host may be lost; "": to any.
    void resend(const std::string& host) {
        for (auto& [key, packet] : pending)
            if (host.empty() || packet.host == host) packet.sent = false, unsent = true;
    }

    void look_after_pending() {
        const auto now = Clock::now();
        if (!unsent && now - looked < socket_look_interval) return;
        if (now - looked >= socket_look_interval) {
            looked = now;
            for (auto& [host, peer] : peers) {
                if (now - std::max(peer.asked, peer.answered) <= peer.patience || !has_pending(host)) continue;
                peer.patience *= 2;
                resend(host);
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
        auto& peer = peers[found->second.host];
        peer.answered = Clock::now();
        peer.patience = shortest_patience;
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
        for (std::size_t i = hops; i < frames.size(); ++i) frames[i] = MessageFrame();  // the asker must send it again
        answering->socket.send(frames);
        return std::nullopt;
    }

    std::optional<Message> from_answerer(const std::string& endpoint, Frames frames) {
        if (endpoint != gateway_endpoint(me.run)) {
            asked_here -= asked_here > 0;
            return take_message(frames[0]);
        }
        if (frames.size() == 1) {
            resend(text_of(frames[0]));
            return std::nullopt;
        }
        auto message = frames.size() == 2 ? from_packet(frames, 0) : std::nullopt;  // a flipped bit splits messages
        if (message)
            settle({message->channel, message->bundle});
        else
            resend("");
        return message;
    }
};

ZmqCarrier::ZmqCarrier(const SocketContext& context, Address me, PlaceTransport::AtFault at_fault)
    : sockets_(new Sockets{context, std::move(me), std::move(at_fault)}) {
    const auto& my = sockets_->me;
    if (!my.place) return;
    sockets_->answering.emplace(Sockets::Source{answering_socket(context)});
    sockets_->answering->socket.bind(inproc_endpoint(my.run, *my.place));
}

ZmqCarrier::~ZmqCarrier() = default;

bool ZmqCarrier::ask(const PlaceAt& to, Message& message) {
    auto& s = *sockets_;
    if (to.host == s.me.host) {
        auto frames = frames_of(std::move(message));
        if (s.to(inproc_endpoint(s.me.run, to.index)).send(frames)) {
            ++s.asked_here;
            return true;
        }
        message = take_message(frames[0]);
        if (!may_be_full(s.asked_here)) return false;  // it has ended
    } else {
        auto packet = packet::pack(message, to.index);
        Sockets::Pending kept{to.host, MessageFrame(std::move(packet.header)), MessageFrame(std::move(packet.body)),
                              true};
        if (s.send(kept)) {
            s.pending.insert_or_assign({message.channel, message.bundle}, std::move(kept));
            return true;
        }
        if (!may_be_full(s.pending.size())) return false;  // the run ends
    }
    ++s.counters.refused_sends;
    return false;
}

void ZmqCarrier::reply(Message message) {
    Frames frames;
    for (const auto& hop : message.route.hops) frames.emplace_back(hop);
    if (frames.size() > 1) {
        append(frames, packet::pack(message, 0));
        for (std::size_t i = message.route.hops.size(); i < frames.size(); ++i)
            sockets_->counters.bytes += frames[i].size();
    } else {
        frames.emplace_back(std::move(message));
    }
    // Who has gone meanwhile wants no answer: it was asked of several, or the run is over.
    if (sockets_->answering->socket.try_send(frames) == SendResult::line_is_full) ++sockets_->counters.refused_sends;
}

std::optional<Message> ZmqCarrier::receive() {
    auto& s = *sockets_;
    if (s.all_dry()) s.look(std::chrono::milliseconds(0));
    const auto take = [](Sockets::Source& source, const auto& read) -> std::optional<Message> {
        while (!source.dry) {
            auto frames = source.socket.receive();
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
    if (!s.pending.empty()) s.look_after_pending();
    return std::nullopt;
}

// DECISIONS: who-waits-sleeps
void ZmqCarrier::wait(std::chrono::nanoseconds most) {
    const auto ms = std::chrono::ceil<std::chrono::milliseconds>(most);
    sockets_->look(std::max(ms, std::chrono::milliseconds(1)));
}

void ZmqCarrier::give_up(std::uint32_t channel) {
    std::erase_if(sockets_->pending, [&](const auto& one) { return one.first.first == channel; });
}

bool ZmqCarrier::take_out(const std::string& host, const std::string& why) {
    sockets_->at_fault({why, host});
    return true;
}

void ZmqCarrier::doubt(const Failure& lie) { sockets_->at_fault(lie); }

void ZmqCarrier::forget(const PlaceAt& place) {
    if (!sockets_->has_pending(place.host)) sockets_->peers.erase(place.host);
}

const Counters& ZmqCarrier::counters() const { return sockets_->counters; }

}  // namespace lightnet
