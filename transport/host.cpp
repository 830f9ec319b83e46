#include "transport/host.hpp"

#include <algorithm>
#include <chrono>
#include <random>
#include <thread>
#include <zmq.hpp>

#include "core/build_info.hpp"
#include "core/error.hpp"
#include "core/runtime/fingerprint.hpp"
#include "transport/blob_cache.hpp"
#include "transport/hosted_run.hpp"
#include "transport/sockets.hpp"

namespace lightnet {
namespace {

using Clock = std::chrono::steady_clock;
using packet::Fields;
using packet::Type;

constexpr auto launcher_lease = std::chrono::seconds(4);    // without a word, its run is over
constexpr auto leaving_deadline = std::chrono::seconds(5);  // for the launcher to let us go
constexpr auto join_interval = std::chrono::milliseconds(500);

std::uint64_t random_number() {
    std::random_device device;  // names an incarnation; nothing that is computed depends on it
    return (std::uint64_t{device()} << 32) | device();
}

bool is_work(Type type) { return type < Type::hello; }

}  // namespace

struct Host::Door {
    Options options;
    const Registry& registry;
    BlobCache cache;
    zmq::context_t context{1};
    zmq::socket_t socket;                  // the one port
    std::optional<zmq::socket_t> joining;  // to a launcher that was dialled
    Clock::time_point next_join{};
    std::uint64_t incarnation = random_number();
    std::uint64_t broken_packets = 0;
    std::unique_ptr<HostedRun> run;
    std::string launcher;                      // route to who began the run
    Clock::time_point heard{};                 // from it
    std::optional<Clock::time_point> leaving;  // since when

    Door(Options given, const Registry& kinds)
        : options(std::move(given)),
          registry(kinds),
          cache(options.cache.empty() ? default_cache_folder() : options.cache),
          socket(answering_socket(context)) {
        if (!options.places) options.places = std::max(1u, std::thread::hardware_concurrency());
        try {
            socket.bind(options.listen);
        } catch (const zmq::error_t& error) {
            throw Error(options.listen, std::string("can't listen there: ") + error.what());
        }
        if (!options.join.empty()) joining.emplace(asking_socket(context, options.join));
        cache.trim();
    }

    std::string endpoint() const { return socket.get(zmq::sockopt::last_endpoint); }

    void send(const std::string& route, Type type, std::uint64_t id, const Fields& fields) {
        Frames frames;
        frames.push_back(frame_of(route));
        append(frames, packet::pack(type, id, fields));
        send_frames(socket, frames);
    }

    void arrived(Frames frames);
    void control(const std::string& route, const packet::Header& header, const Fields& fields);
    void greet(const std::string& route, const Fields& fields);
    void begin(const std::string& route, std::uint64_t id, const Fields& fields);
    void tell_needs();
    void tell_found();
    void take_blob(const std::string& route, std::uint64_t id, const Fields& fields);
    void end(const std::string& route, std::uint64_t id);
    void drop_run(const std::string& why);
    void advance();
    // Who has something to be read. Looking at an empty socket costs a system call, so only these are looked at.
    struct Readable {
        bool door = false, reports = false;
        std::vector<std::uint32_t> places;
    };
    Readable wait();
    void take_in();
    void pass_replies(std::uint32_t place);
    void keep_joining(Clock::time_point now);
};

Host::Host(Options options, const Registry& registry) : door_(std::make_unique<Door>(std::move(options), registry)) {}
Host::~Host() = default;
std::string Host::endpoint() const { return door_->endpoint(); }

void Host::serve(const std::atomic<bool>& stop) {
    auto& door = *door_;
    while (true) {
        const auto now = Clock::now();
        if (stop && !door.leaving) {
            door.leaving = now;
            if (door.run) door.send(door.launcher, Type::leaving, door.run->id(), {});
        }
        if (door.leaving && (!door.run || now - *door.leaving > leaving_deadline)) break;
        const auto readable = door.wait();
        for (const auto place : readable.places) door.pass_replies(place);
        if (readable.door) door.take_in();
        if (readable.reports || (door.run && !door.run->serving())) door.advance();
        if (door.run && door.run->looking_for_results()) door.tell_found();
        if (door.run && now - door.heard > launcher_lease) door.drop_run("its launcher is silent");
        door.keep_joining(now);
    }
    if (door.run) door.drop_run("this host is stopping");
}

void Host::Door::arrived(Frames frames) {
    if (frames.size() != 3) {
        ++broken_packets;
        return;
    }
    const auto header_bytes = bytes_of(frames[1]);
    const auto route = text_of(frames[0]);
    const auto header = packet::peek_header(header_bytes);
    if (!header) {
        const auto theirs = packet::claimed_version(header_bytes);
        if (theirs && *theirs != packet::version)
            send(route, Type::refuse, 0,
                 Fields{}.set("text", "protocol version " + std::to_string(packet::version) + " is spoken here, not " +
                                          std::to_string(*theirs)));
        ++broken_packets;
        return;
    }
    if (is_work(header->type)) {  // not looked into: the place checks and decodes
        if (!run || header->run != run->id() || !run->serving() || header->place >= run->places()->count()) return;
        send_frames(run->places()->to(header->place), frames);
        return;
    }
    const auto body = bytes_of(frames[2]);
    const auto fields = packet::read_header(header_bytes, body) ? packet::unpack_fields(body) : std::nullopt;
    if (!fields) {
        ++broken_packets;
        return;
    }
    try {
        control(route, *header, *fields);
    } catch (const std::exception& error) {
        send(route, Type::broken, header->run, Fields{}.set("text", error.what()));
        if (run && run->id() == header->run) drop_run(error.what());
    }
}

void Host::Door::control(const std::string& route, const packet::Header& header, const Fields& fields) {
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
            return send(route, Type::pong, header.run,
                        Fields{}
                            .set("incarnation", incarnation)
                            .set("run", run ? run->id() : 0)
                            .set("progress", run && run->places() ? run->places()->progress() : 0));
        case Type::plan:
            if (ours) run->use(plan_from_json(fields.text("plan")));
            return;
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

void Host::Door::greet(const std::string& route, const Fields& fields) {
    if (leaving) return send(route, Type::refuse, 0, Fields{}.set("text", "it is stopping"));
    if (fields.text("build") != build_id())
        return send(
            route, Type::refuse, 0,
            Fields{}.set("text", "builds differ: it runs " + build_id() + ", the launcher " + fields.text("build")));
    try {
        send(route, Type::welcome, 0,
             Fields{}
                 .set("places", options.places)
                 .set("incarnation", incarnation)
                 .set("fingerprint", fingerprint(fields.text("isa"))));
    } catch (const Error& error) {  // a processor without that instruction set
        send(route, Type::refuse, 0, Fields{}.set("text", error.what()));
    }
}

void Host::Door::begin(const std::string& route, std::uint64_t id, const Fields& fields) {
    if (run && run->id() != id)
        return send(route, Type::refuse, id, Fields{}.set("text", "it serves another run").set("busy", 1));
    if (!run) {
        Plan plan = plan_from_json(fields.text("plan"));
        // a hosts file may ask for more places than there are cores
        const auto mine = std::count_if(plan.places.begin(), plan.places.end(),
                                        [&](const PlaceAt& place) { return place.host == fields.text("you"); });
        HostedRun::Given given{id, fields.text("you"), std::max(options.places, static_cast<std::uint32_t>(mine)),
                               std::move(plan), job_from_json(fields.text("job"))};
        run = std::make_unique<HostedRun>(context, cache, registry, std::move(given));
        options.log("serves a run");
    }
    launcher = route;
    heard = Clock::now();
    run->use(plan_from_json(fields.text("plan")));
    run->expect_files_anew();
    if (run->state() != HostedRun::State::looking) tell_needs();
    if (run->serving()) send(route, Type::ready, id, {});  // the launcher had lost sight of us
}

void Host::Door::tell_needs() {
    std::string missing;
    for (const auto& hash : run->missing()) missing += to_hex(hash);
    send(launcher, Type::need, run->id(), Fields{}.set("hashes", missing));
}

void Host::Door::tell_found() {
    if (!run) return;
    for (const auto& [hash, here] : run->found())
        send(launcher, here ? Type::here : Type::lacks, run->id(), Fields{}.set("hash", to_hex(hash)));
}

void Host::Door::take_blob(const std::string& route, std::uint64_t id, const Fields& fields) {
    const auto hash = hash_from_hex(fields.text("hash"));
    if (!run || run->id() != id || !hash) return;
    if (run->take_blob(*hash, fields.number("offset"), fields.text("bytes")))
        send(route, Type::blob_taken, id,
             Fields{}.set("hash", fields.text("hash")).set("offset", fields.number("offset")));
    tell_found();
}

void Host::Door::end(const std::string& route, std::uint64_t id) {
    Counters counters;
    if (run && run->id() == id) {
        counters = run->stop();
        run.reset();
        options.log("the run has ended");
    }
    Fields fields;
    for (const auto& [name, count] : counters.named()) fields.set(name, count);
    send(route, Type::ended, id, fields);
}

void Host::Door::drop_run(const std::string& why) {
    run->stop();
    run.reset();
    options.log("the run is given up: " + why);
}

void Host::Door::advance() {
    if (!run) return;
    try {
        while (run->advance()) {
            if (run->state() == HostedRun::State::fetching) tell_needs();
            if (run->serving()) send(launcher, Type::ready, run->id(), {});
        }
    } catch (const std::exception& error) {
        send(launcher, Type::broken, run->id(), Fields{}.set("text", error.what()));
        drop_run(error.what());
    }
}

void Host::Door::take_in() {
    while (auto frames = receive_frames(socket)) arrived(std::move(*frames));
}

void Host::Door::pass_replies(std::uint32_t place) {
    while (auto frames = receive_frames(run->places()->to(place))) send_frames(socket, *frames);
}

void Host::Door::keep_joining(Clock::time_point now) {
    if (!joining || leaving) return;
    while (receive_frames(*joining)) {
    }  // `joined`: nothing to do but to stay in touch
    if (now < next_join) return;
    next_join = now + join_interval;
    Frames frames;
    append(frames, packet::pack(Type::join, 0, Fields{}.set("endpoint", endpoint())));
    send_frames(*joining, frames);
}

Host::Door::Readable Host::Door::wait() {
    std::vector<zmq::pollitem_t> items{{socket.handle(), 0, ZMQ_POLLIN, 0}};
    const bool building = run && (!run->serving() || run->looking_for_results());
    if (run && run->serving()) {
        items.push_back({run->places()->reports().handle(), 0, ZMQ_POLLIN, 0});
        for (std::uint32_t place = 0; place < run->places()->count(); ++place)
            items.push_back({run->places()->to(place).handle(), 0, ZMQ_POLLIN, 0});
    }
    try {
        zmq::poll(items, std::chrono::milliseconds(building ? 5 : 100));
    } catch (const zmq::error_t& error) {
        if (error.num() != EINTR) throw;
    }
    const auto has_some = [&](std::size_t item) { return (items[item].revents & ZMQ_POLLIN) != 0; };
    Readable readable{has_some(0), items.size() > 1 && has_some(1), {}};
    for (std::size_t item = 2; item < items.size(); ++item)
        if (has_some(item)) readable.places.push_back(static_cast<std::uint32_t>(item - 2));
    return readable;
}

}  // namespace lightnet
