#include "transport/host.hpp"

#include <algorithm>
#include <zmq.hpp>

#include "core/error.hpp"
#include "transport/host_service.hpp"
#include "transport/relay.hpp"

namespace lightnet {
namespace {

using Clock = std::chrono::steady_clock;
using packet::Fields;
using packet::Type;

constexpr auto launcher_lease = std::chrono::seconds(4);               // without a word, its run is over
constexpr auto quiet_before_leaving = std::chrono::milliseconds(300);  // askers may not know yet that it leaves
constexpr auto goodbye_deadline = std::chrono::milliseconds(500);

}  // namespace

Host::Service::Service(Options given_options, const Registry& kinds)
    : options(std::move(given_options)),
      registry(kinds),
      cache(options.cache.empty() ? default_cache_folder() : options.cache, options.cache_size),
      context(std::make_unique<zmq::context_t>(1)),
      door(*context, {options.listen, options.join, options.name.empty() ? machine.name : options.name, process}) {
    if (!options.places) options.places = static_cast<std::uint32_t>(machine.cores);
    cache.trim();
}

Host::Service::~Service() = default;

Host::Host(Options options, const Registry& registry)
    : service_(std::make_unique<Service>(std::move(options), registry)) {}
Host::~Host() = default;
std::string Host::endpoint() const { return service_->door.endpoint(); }

void Host::serve(const std::atomic<bool>& stop) {
    auto& s = *service_;
    s.needed = Clock::now();
    while (true) {
        const auto now = Clock::now();
        if (stop && !s.leaving) s.leave(now);
        if (s.leaving && s.gone(now)) break;
        const auto readable = s.wait();
        for (const auto place : readable.places) s.pass_replies(place);
        if (readable.door)
            while (auto frames = s.door.receive(Clock::now())) s.arrived(std::move(*frames));
        if (readable.relay) s.pass_asks();
        if (readable.reports || (s.run && !s.run->serving())) s.advance();
        if (readable.news) s.tell_found();
        if (s.run && now - s.heard > launcher_lease) s.drop_run("its launcher is silent");
        if (!s.leaving) s.door.keep_in_touch(now);
        if (s.run) s.needed = now;
        if (s.options.patience && now - s.needed > *s.options.patience) {
            s.options.log("nobody needs it any more");
            break;
        }
    }
    if (s.run) s.drop_run("this host is stopping");
}

void Host::Service::arrived(Frames frames) {
    const auto route = text_of(frames[0]);
    if (frames.size() == 2 && frames[1].size() == 0) {  // what went through the launcher may be lost
        if (relay && route == launcher) relay->say_again();
        return;
    }
    if (frames.size() < 3) return damaged(route);
    const auto header_bytes = bytes_of(frames[frames.size() - 2]);
    const auto header = packet::peek_header(header_bytes);
    const bool plain = frames.size() == 3;
    if (header && plain && packet::is_ask(header->type)) return work(*header, std::move(frames));
    if (header && frames.size() == 4 && header->type < Type::hello) return from_another(*header, std::move(frames));
    const auto body = bytes_of(frames.back());
    const bool sound = header && plain && packet::read_header(header_bytes, body);
    const auto piece = sound && header->type == Type::blob ? packet::unpack_piece(body) : std::nullopt;
    const auto fields = sound && header->type != Type::blob ? packet::unpack_fields(body) : std::nullopt;
    if (!piece && !fields) {
        const auto theirs = packet::claimed_version(header_bytes);
        if (theirs && *theirs != packet::version)
            door.send(route, Type::refuse, 0,
                      Fields{}.set("text", "protocol version " + std::to_string(packet::version) +
                                               " is spoken here, not " + std::to_string(*theirs)));
        return damaged(route);
    }
    try {
        if (run && header->run == run->id()) heard = std::chrono::steady_clock::now();
        if (piece)
            take_blob(route, header->run, *piece);
        else
            control(route, *header, *fields);
    } catch (const std::exception& error) {
        door.send(route, Type::broken, header->run, Fields{}.set("text", error.what()));
        if (run && run->id() == header->run) drop_run(error.what());
    }
}

// Whoever sent it must say it again.
void Host::Service::damaged(const std::string& route) {
    ++broken_packets;
    auto again = empty_message();
    door.send(route, again);
}

// Not looked into: the place checks and decodes.
void Host::Service::work(const packet::Header& header, Frames frames) {
    if (!run || header.run != run->id() || !run->serving()) return;
    if (header.place >= run->places()->count() || !send_frames(run->places()->to(header.place), frames)) {
        frames.resize(frames.size() - 2);
        frames.emplace_back();
        frames.emplace_back();
        door.send(frames);  // say it again
        return;
    }
    given += header.width > 0;
    if (leaving) leaving->last_work = Clock::now();
}

// [route][address][header][body], through the launcher: an ask, or the reply to one of ours.
void Host::Service::from_another(const packet::Header& header, Frames frames) {
    if (packet::is_ask(header.type)) return work(header, std::move(frames));
    if (!relay || header.run != run->id()) return;
    const auto address = unseal(bytes_of(frames[1]));
    frames.erase(frames.begin(), frames.begin() + 2);
    if (!address || !relay->pass(address->place, frames)) relay->say_again();
}

void Host::Service::advance() {
    if (!run) return;
    try {
        while (run->advance()) {
            if (run->state() == HostedRun::State::fetching) tell_needs();
            if (run->serving()) door.send(launcher, Type::ready, run->id(), {});
        }
    } catch (const std::exception& error) {
        door.send(launcher, Type::broken, run->id(), Fields{}.set("text", error.what()));
        drop_run(error.what());
    }
}

void Host::Service::pass_replies(std::uint32_t place) {
    if (!run || !run->serving()) return;
    while (auto frames = receive_frames(run->places()->to(place))) {
        if (frames->size() < 3) continue;
        const auto header = packet::peek_header(bytes_of((*frames)[frames->size() - 2]));
        answered += !header || header->width > 0;  // as in work()
        door.send(*frames);
    }
}

// For hosts that our places can't call: the launcher passes them on.
void Host::Service::pass_asks() {
    if (!relay) return;
    while (auto frames = relay->receive()) {
        const auto place = text_of((*frames)[0]), host = text_of((*frames)[1]);
        (*frames)[0] = frame_of(launcher);
        (*frames)[1] = frame_of(seal({host, place}));
        door.send(*frames);  // if it fails the launcher greets us anew, and all is said again
    }
}

void Host::Service::leave(Clock::time_point now) {
    leaving = Leaving{now, now, false, std::nullopt};
    if (!run) return;
    options.log("finishes what it has, then stops");
    door.send(launcher, Type::leaving, run->id(), {});
    if (run->serving()) return;
    drop_run("this host is stopping");
    leaving->farewell = now;
}

bool Host::Service::gone(Clock::time_point now) {
    if (leaving->farewell) return !run && now - *leaving->farewell > goodbye_deadline;
    if (!run) return true;
    if (now - leaving->since > options.drain) return true;
    const bool idle = answered >= given && now - leaving->last_work > quiet_before_leaving;
    if (!leaving->known || !idle) return false;
    end(launcher, run->id());
    leaving->farewell = now;
    return false;
}

Host::Service::Readable Host::Service::wait() {
    std::vector<zmq::pollitem_t> items;
    for (auto* socket : door.sockets()) items.push_back({socket->handle(), 0, ZMQ_POLLIN, 0});
    const std::size_t doors = items.size();
    auto* const places = run ? run->places() : nullptr;
    if (run) {
        items.push_back({relay->socket().handle(), 0, ZMQ_POLLIN, 0});
        items.push_back({nullptr, run->news(), ZMQ_POLLIN, 0});
    }
    if (places) items.push_back({places->reports().handle(), 0, ZMQ_POLLIN, 0});
    const std::size_t others = items.size();
    for (std::uint32_t place = 0; places && run->serving() && place < places->count(); ++place)
        items.push_back({places->to(place).handle(), 0, ZMQ_POLLIN, 0});
    try {
        zmq::poll(items, std::chrono::milliseconds(leaving ? 5 : 100));
    } catch (const zmq::error_t& error) {
        if (error.num() != EINTR) throw;
    }
    const auto has_some = [&](std::size_t item) { return (items[item].revents & ZMQ_POLLIN) != 0; };
    Readable readable;
    for (std::size_t item = 0; item < doors; ++item) readable.door |= has_some(item);
    if (!run) return readable;
    readable.relay = has_some(doors);
    readable.news = has_some(doors + 1);
    if (readable.news) run->clear_news();
    readable.reports = places && has_some(doors + 2);
    for (std::size_t item = others; item < items.size(); ++item)
        if (has_some(item)) readable.places.push_back(static_cast<std::uint32_t>(item - others));
    return readable;
}

}  // namespace lightnet
