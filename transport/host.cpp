#include "transport/host.hpp"

#include <algorithm>
#include <zmq.hpp>

#include "core/build_info.hpp"
#include "core/error.hpp"
#include "core/runtime/fingerprint.hpp"
#include "transport/blob_cache.hpp"
#include "transport/host_door.hpp"
#include "transport/hosted_run.hpp"
#include "transport/machine.hpp"
#include "transport/relay.hpp"
#include "transport/relay_door.hpp"

namespace lightnet {
namespace {

using Clock = std::chrono::steady_clock;
using packet::Fields;
using packet::Type;

constexpr auto launcher_lease = std::chrono::seconds(4);               // without a word, its run is over
constexpr auto quiet_before_leaving = std::chrono::milliseconds(300);  // askers may not know yet that it leaves
constexpr auto goodbye_deadline = std::chrono::milliseconds(500);

}  // namespace

struct Host::Service {
    Options options;
    const Registry& registry;
    BlobCache cache;
    Machine machine = this_machine();
    std::uint64_t incarnation = incarnation_number();
    zmq::context_t context{1};
    HostDoor door;
    std::uint64_t broken_packets = 0;
    std::unique_ptr<HostedRun> run;
    std::unique_ptr<RelayDoor> relay;       // of the run
    std::string who;                        // began it
    std::string launcher;                   // route to it
    Clock::time_point heard{};              // from it
    std::uint64_t given = 0, answered = 0;  // asks of others
    Clock::time_point needed{};             // last, by anyone

    // On the way out: told to stop, the launcher gives no more work, what was given is answered, it says farewell.
    struct Leaving {
        Clock::time_point since, last_work;
        bool known = false;  // to the launcher
        std::optional<Clock::time_point> farewell;
    };
    std::optional<Leaving> leaving;

    Service(Options given_options, const Registry& kinds)
        : options(std::move(given_options)),
          registry(kinds),
          cache(options.cache.empty() ? default_cache_folder() : options.cache),
          door(context,
               {options.listen, options.join, options.name.empty() ? machine.name : options.name, incarnation}) {
        if (!options.places) options.places = static_cast<std::uint32_t>(machine.cores);
        cache.trim();
    }

    void arrived(Frames frames);
    void damaged(const std::string& route);
    void work(const packet::Header& header, Frames frames);
    void from_another(const packet::Header& header, Frames frames);
    void control(const std::string& route, const packet::Header& header, const Fields& fields);
    void greet(const std::string& route, const Fields& fields);
    void begin(const std::string& route, std::uint64_t id, const Fields& fields);
    void tell_needs();
    void tell_state(const std::string& route);
    void tell_found();
    void take_blob(const std::string& route, std::uint64_t id, const Fields& fields);
    Counters stop_run();
    void end(const std::string& route, std::uint64_t id);
    void drop_run(const std::string& why);
    void advance();
    // Who has something to be read. Looking at an empty socket costs a system call, so only these are looked at.
    struct Readable {
        bool door = false, relay = false, reports = false;
        std::vector<std::uint32_t> places;
    };
    Readable wait();
    void pass_replies(std::uint32_t place);
    void pass_asks();
    void leave(Clock::time_point now);
    bool gone(Clock::time_point now);
};

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
        if (s.run && s.run->looking_for_results()) s.tell_found();
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
    const auto fields =
        header && plain && packet::read_header(header_bytes, body) ? packet::unpack_fields(body) : std::nullopt;
    if (!fields) {
        const auto theirs = packet::claimed_version(header_bytes);
        if (theirs && *theirs != packet::version)
            door.send(route, Type::refuse, 0,
                      Fields{}.set("text", "protocol version " + std::to_string(packet::version) +
                                               " is spoken here, not " + std::to_string(*theirs)));
        return damaged(route);
    }
    try {
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
    ++given;
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

void Host::Service::control(const std::string& route, const packet::Header& header, const Fields& fields) {
    const bool ours = run && header.run == run->id();
    if (ours) heard = Clock::now();
    switch (header.type) {
        case Type::hello:
            return greet(route, fields);
        case Type::begin:
            return begin(route, header.run, fields);
        case Type::blob:
            return take_blob(route, header.run, fields);
        case Type::ping:
            return door.send(route, Type::pong, header.run,
                             Fields{}
                                 .set("incarnation", incarnation)
                                 .set("run", run ? run->id() : 0)
                                 .set("progress", run && run->places() ? run->places()->progress() : 0));
        case Type::plan:
            if (ours) run->use(plan_from_json(fields.text("plan")));
            if (ours && leaving) leaving->known = true;
            return;
        case Type::status:
            return tell_state(route);
        case Type::expect:
            if (const auto hash = hash_from_hex(fields.text("hash")); ours && hash)
                run->expect(*hash, fields.number("size"));
            return tell_found();
        case Type::end:
            return end(route, header.run);
        default:
            return;
    }
}

void Host::Service::greet(const std::string& route, const Fields& fields) {
    if (leaving) return;  // whoever comes after it may serve
    if (fields.text("build") != build_id())
        return door.send(
            route, Type::refuse, 0,
            Fields{}.set("text", "builds differ: it runs " + build_id() + ", the launcher " + fields.text("build")));
    try {
        Fields answer;
        set(answer, machine);
        answer.set("places", options.places)
            .set("incarnation", incarnation)
            .set("fingerprint", fingerprint(fields.text("isa")));
        door.send(route, Type::welcome, 0, answer);
    } catch (const Error& error) {  // a processor without that instruction set
        door.send(route, Type::refuse, 0, Fields{}.set("text", error.what()));
    }
}

void Host::Service::begin(const std::string& route, std::uint64_t id, const Fields& fields) {
    if (leaving) return;
    if (run && run->id() != id)
        return door.send(
            route, Type::refuse, id,
            Fields{}.set("text", "it serves another run" + (who.empty() ? "" : ", of " + who)).set("busy", 1));
    if (!run) {
        Plan plan = plan_from_json(fields.text("plan"));
        // a hosts file may ask for more places than there are cores
        const auto mine = std::count_if(plan.places.begin(), plan.places.end(),
                                        [&](const PlaceAt& place) { return place.host == fields.text("you"); });
        HostedRun::Given job{id, fields.text("you"), std::max(options.places, static_cast<std::uint32_t>(mine)),
                             std::move(plan), job_from_json(fields.text("job"))};
        run = std::make_unique<HostedRun>(context, cache, registry, std::move(job));
        relay = std::make_unique<RelayDoor>(context, id);
        who = fields.text("who");
        given = answered = 0;
        options.log("serves a run" + (who.empty() ? "" : " of " + who));
    }
    launcher = route;
    heard = Clock::now();
    run->use(plan_from_json(fields.text("plan")));
    run->expect_files_anew();
    relay->say_again();
    if (run->state() != HostedRun::State::looking) tell_needs();
    if (run->serving()) door.send(route, Type::ready, id, {});  // the launcher had lost sight of us
}

void Host::Service::tell_needs() {
    std::string missing;
    for (const auto& hash : run->missing()) missing += to_hex(hash);
    door.send(launcher, Type::need, run->id(), Fields{}.set("hashes", missing));
}

void Host::Service::tell_found() {
    if (!run) return;
    for (const auto& [hash, here] : run->found())
        door.send(launcher, here ? Type::here : Type::lacks, run->id(), Fields{}.set("hash", to_hex(hash)));
}

void Host::Service::tell_state(const std::string& route) {
    Fields fields;
    set(fields, machine);
    fields.set("name", options.name.empty() ? machine.name : options.name).set("places", options.places);
    fields.set("state", leaving ? "leaves" : run ? run->words() : "is free").set("who", run ? who : "");
    fields.set("broken_packets", broken_packets);
    if (run) {
        fields.set("nodes", run->nodes()).set("bundles", given);
        fields.set("progress", run->places() ? run->places()->progress() : 0);
    }
    door.send(route, Type::state, run ? run->id() : 0, fields);
}

void Host::Service::take_blob(const std::string& route, std::uint64_t id, const Fields& fields) {
    const auto hash = hash_from_hex(fields.text("hash"));
    if (!run || run->id() != id || !hash) return;
    if (run->take_blob(*hash, fields.number("offset"), fields.text("bytes")))
        door.send(route, Type::blob_taken, id,
                  Fields{}.set("hash", fields.text("hash")).set("offset", fields.number("offset")));
    tell_found();
}

Counters Host::Service::stop_run() {
    auto counters = run->stop();
    counters.broken_packets += std::exchange(broken_packets, 0);
    relay.reset();
    run.reset();
    return counters;
}

void Host::Service::end(const std::string& route, std::uint64_t id) {
    Counters counters;
    if (run && run->id() == id) {
        counters = stop_run();
        options.log("the run has ended");
    }
    Fields fields;
    for (const auto& [name, count] : counters.named()) fields.set(name, count);
    door.send(route, Type::ended, id, fields);
}

void Host::Service::drop_run(const std::string& why) {
    stop_run();
    options.log("the run is given up: " + why);
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
        ++answered;
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
    const bool serving = run && run->serving();
    if (relay) items.push_back({relay->socket().handle(), 0, ZMQ_POLLIN, 0});
    if (serving) {
        items.push_back({run->places()->reports().handle(), 0, ZMQ_POLLIN, 0});
        for (std::uint32_t place = 0; place < run->places()->count(); ++place)
            items.push_back({run->places()->to(place).handle(), 0, ZMQ_POLLIN, 0});
    }
    const bool soon = (run && (!serving || run->looking_for_results())) || leaving;
    try {
        zmq::poll(items, std::chrono::milliseconds(soon ? 5 : 100));
    } catch (const zmq::error_t& error) {
        if (error.num() != EINTR) throw;
    }
    const auto has_some = [&](std::size_t item) { return (items[item].revents & ZMQ_POLLIN) != 0; };
    Readable readable;
    for (std::size_t item = 0; item < doors; ++item) readable.door |= has_some(item);
    if (relay) readable.relay = has_some(doors);
    if (!serving) return readable;
    readable.reports = has_some(doors + 1);
    for (std::size_t item = doors + 2; item < items.size(); ++item)
        if (has_some(item)) readable.places.push_back(static_cast<std::uint32_t>(item - doors - 2));
    return readable;
}

}  // namespace lightnet
