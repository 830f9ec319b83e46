#include "transport/zmq/zmq_carrier.hpp"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "transport/lines/poll.hpp"
#include "transport/zmq/gateway.hpp"
#include "transport/zmq/own_lines.hpp"

namespace lightnet {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto socket_look_interval = std::chrono::milliseconds(200);
// After so long without any answer packets are sent again: a flipped bit can make a message vanish without a trace. The
// next time the host is given twice as long (exponential backoff), since it may just be slow.
// DECISIONS: say-it-again
constexpr auto shortest_patience = std::chrono::milliseconds(3000);
// The first hop of what came by the queue; those of ZeroMQ begin with a zero.
const std::string by_queue = "queue";

}  // namespace

std::string inproc_endpoint(std::uint64_t run, std::uint32_t place) {
    return "inproc://run-" + std::to_string(run) + "/place-" + std::to_string(place);
}

void ZmqCarrier::Queues::put_reply(Frames& frames) const {
    replies->push_always(frames);
    if (door) door->send(*replies);
}

struct ZmqCarrier::Sockets {
    // Another host.
    struct Peer {
        Clock::time_point asked{}, answered{};  // last
        std::chrono::milliseconds patience = shortest_patience;
    };
    // A packet whose reply is not there yet.
    struct Pending {
        std::string host;
        MessageFrame header, body;
        bool sent = true, on_own_line = false;
        std::size_t size() const { return header.size() + body.size(); }
        void append_to(Frames& frames) {
            for (auto* frame : {&header, &body}) frames.push_back(frame->shared());
        }
    };

    const SocketContext& context;
    Address me;
    PlaceTransport::AtFault at_fault;
    OwnLines own;
    std::optional<Source> answering{};
    std::map<std::string, Source> asking{};  // by endpoint
    Counters counters{};
    std::size_t next = 0;  // fair turns among the asking sockets
    std::map<std::string, Peer> peers{};
    std::map<std::pair<std::uint32_t, std::uint64_t>, Pending> pending{};  // by channel and bundle
    std::size_t asked_here = 0;                                            // of places of this host, and not answered
    bool unsent = false;                                                   // some of them are to be sent again
    Clock::time_point looked{};

    // Looking at all of them at once costs a call of the system, too: that is done when all are dry.
    std::vector<Source*> all() {
        auto sources = own.sources();
        if (answering) sources.push_back(&*answering);
        for (auto& [endpoint, source] : asking) sources.push_back(&source);
        return sources;
    }

    bool all_dry() {
        const auto sources = all();
        return std::ranges::all_of(sources, [](const Source* source) { return source->dry; });
    }

    void look(std::chrono::milliseconds most) {
        const auto sources = all();
        Poll poll;
        for (const auto* source : sources) poll.add(source->socket);
        if (most.count() == 0) {
            poll.wait(most);
        } else {
            if (me.queues.asks) poll.add(*me.queues.asks);
            Leadership::Turn turn(me.queues.led(), me.queues.replies.get());
            turn.watch(poll);
            me.queues.may_lead ? poll.look_and_wait(most) : poll.wait(most);
            turn.look(poll);
        }
        for (std::size_t i = 0; i < sources.size(); ++i) sources[i]->dry = !poll.readable(i);
    }

    Socket& to(const std::string& endpoint) {
        const auto found = asking.find(endpoint);
        if (found != asking.end()) return found->second.socket;
        return asking.emplace(endpoint, Source{asking_socket(context, endpoint)}).first->second.socket;
    }

    // Over a line of this place's own, or by way of the gateway of this process.
    bool send(Pending& packet) {
        leave_own_line(packet);
        Frames frames;
        packet.append_to(frames);
        packet.on_own_line = own.send(packet.host, frames, packet.size());
        if (!packet.on_own_line) {
            frames.emplace(frames.begin(), packet.host);
            if (!to(gateway_endpoint(me.run)).send(frames)) return false;
        }
        peers[packet.host].asked = Clock::now();
        counters.bytes += packet.size();
        return true;
    }

    void leave_own_line(Pending& packet) {
        if (std::exchange(packet.on_own_line, false)) own.settled(packet.host, packet.size());
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
        leave_own_line(found->second);
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

    // [route][pointer]
    std::optional<Message> from_asker(Frames frames) {
        if (frames.size() != 2) return std::nullopt;
        auto message = take_message(frames[1]);
        message.route.hops = {text_of(frames[0])};
        return message;
    }

    // A pointer, or [route][header][body].
    std::optional<Message> from_queue() {
        while (auto frames = me.queues.asks ? me.queues.asks->pop() : std::nullopt) {
            if (frames->size() > 1) {
                if (auto message = from_other_host(*frames)) return message;
                continue;
            }
            auto message = take_message(frames->front());
            message.route.hops = {by_queue};
            return message;
        }
        return std::nullopt;
    }

    std::optional<Message> from_other_host(Frames& frames) {
        if (frames.size() < 3) return std::nullopt;
        const std::size_t hops = frames.size() - 2;
        auto message = from_packet(frames, hops);
        if (message) {
            message->route.hops = {by_queue};
            for (std::size_t i = 0; i < hops; ++i) message->route.hops.push_back(text_of(frames[i]));
            return message;
        }
        for (std::size_t i = hops; i < frames.size(); ++i) frames[i] = MessageFrame();  // the asker must send it again
        me.queues.put_reply(frames);
        return std::nullopt;
    }

    void reply_by_queue(Message message) {
        Frames frames;
        const auto& hops = message.route.hops;
        for (auto hop = hops.begin() + 1; hop != hops.end(); ++hop) frames.emplace_back(*hop);
        if (frames.empty()) {
            frames.emplace_back(std::move(message));
        } else {
            auto packet = packet::pack(message, 0);
            counters.bytes += packet.header.size() + packet.body.size();
            append(frames, std::move(packet));
        }
        me.queues.put_reply(frames);
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
        return from_host("", frames);
    }

    // `host` "": it is not known which.
    std::optional<Message> from_host(const std::string& host, const Frames& frames) {
        auto message = frames.size() == 2 ? from_packet(frames, 0) : std::nullopt;  // a flipped bit splits messages
        if (message)
            settle({message->channel, message->bundle});
        else
            resend(host);
        return message;
    }

    std::optional<Message> from_own_lines() {
        while (auto came = own.receive())
            if (auto message = from_host(came->first, came->second)) return message;
        own.look_into_book([&](const std::string& host) { return has_pending(host); });
        for (const auto& host : own.cut()) {
            for (auto& [key, packet] : pending)
                if (packet.host == host) packet.on_own_line = false;
            resend(host);
        }
        return std::nullopt;
    }
};

ZmqCarrier::ZmqCarrier(const SocketContext& context, Address me, PlaceTransport::AtFault at_fault,
                       std::shared_ptr<const LineBook> lines)
    : sockets_(new Sockets{context, std::move(me), std::move(at_fault), OwnLines(context, std::move(lines))}) {
    const auto& my = sockets_->me;
    if (!my.place) return;
    sockets_->answering.emplace(Source{answering_socket(context)});
    sockets_->answering->socket.bind(inproc_endpoint(my.run, *my.place));
}

ZmqCarrier::~ZmqCarrier() {
    if (sockets_->me.queues.asks) sockets_->me.queues.asks->close();
}

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
    if (!message.route.hops.empty() && message.route.hops.front() == by_queue)
        return sockets_->reply_by_queue(std::move(message));
    Frames frames;
    for (const auto& hop : message.route.hops) frames.emplace_back(hop);
    frames.emplace_back(std::move(message));
    // Who has gone meanwhile wants no answer: it was asked of several, or the run is over.
    if (sockets_->answering->socket.try_send(frames) == SendResult::line_is_full) ++sockets_->counters.refused_sends;
}

std::optional<Message> ZmqCarrier::receive() {
    auto& s = *sockets_;
    if (auto message = s.from_queue()) return message;
    if (s.all_dry()) s.look(std::chrono::milliseconds(0));
    const auto take = [](Source& source, const auto& read) -> std::optional<Message> {
        while (auto frames = source.receive())
            if (auto message = read(std::move(*frames))) return message;
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
    if (auto message = s.from_own_lines()) return message;
    if (!s.pending.empty()) s.look_after_pending();
    return std::nullopt;
}

// DECISIONS: who-waits-sleeps
void ZmqCarrier::wait(std::chrono::nanoseconds most) {
    const auto ms = std::chrono::ceil<std::chrono::milliseconds>(most);
    sockets_->look(std::max(ms, std::chrono::milliseconds(1)));
    const auto& queues = sockets_->me.queues;
    if (queues.door) queues.door->send(*queues.replies);  // what others have put there while this place led
}

void ZmqCarrier::give_up(std::uint32_t channel) {
    auto& pending = sockets_->pending;
    for (auto& [key, packet] : pending)
        if (key.first == channel) sockets_->leave_own_line(packet);
    std::erase_if(pending, [&](const auto& one) { return one.first.first == channel; });
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
