#include "transport/daemon/host.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/words_of.hpp"
#include "transport/daemon/host_service.hpp"
#include "transport/keys/key_file.hpp"
#include "transport/store/cache_folder.hpp"
#include "transport/wire/relay_address.hpp"

namespace lightnet {
namespace {

using Clock = std::chrono::steady_clock;
using packet::Fields;
using packet::Type;

constexpr auto quiet_before_leaving = std::chrono::milliseconds(300);  // askers may not know yet that it leaves
constexpr std::size_t most_told = 1000;                                // strangers, one by one
constexpr int most_failed_turns = 20;                                  // of serve(): it can't go on
constexpr auto turn_interval = std::chrono::milliseconds(100);
constexpr auto goodbye_deadline = std::chrono::milliseconds(500);

// Says who was turned away, and what would let him in; once, as there may be floods.
std::function<void(const PublicKey&, const std::string&)> teller_of_strangers(const Host::Options& options,
                                                                              const std::string& list) {
    const auto told = std::make_shared<std::set<PublicKey>>();
    return [told, list, log = options.log](const PublicKey& key, const std::string& address) {
        if (told->size() >= most_told || !told->insert(key).second) return;
        log({LogLevel::warning, "turns away " + address + ": its key (fingerprint " + key.fingerprint() +
                                    ") is not on the list (" + list +
                                    "); to let it in, append this line: " + key.text() + " NAME"});
    };
}

}  // namespace

HostDoor::Options Host::Service::door_options() const {
    HostDoor::Options made{options.listen, options.join, options.name.empty() ? machine.name : options.name, process};
    made.log = options.log;
    made.line_life = options.line_life;
    const bool with_keys = rights.asks_for_keys();
    if (with_keys && !options.key) throw Error("a host that asks for keys needs one of its own");
    if (with_keys)
        made.keys = {
            *options.key, [this](const PublicKey& key) { return rights.knows(key); },
            teller_of_strangers(options, rights.list_name()),
            [log = options.log, told = std::make_shared<bool>(false)] {
                if (!std::exchange(*told, true))
                    log({LogLevel::warning, "turns away somebody who has no key, or takes this host for another"});
            }};
    if (options.launcher_key) {
        made.launcher = LineKeys{*options.key, *options.launcher_key};
    } else if (!options.join.empty()) {
        keep_secrets_out_of_dumps();
        made.pass = Pass::of(options.pass.empty() ? Pass::usual_file() : options.pass);
    }
    return made;
}

Host::Options Host::Service::ready(Options wanted) const {
    if (!wanted.transport) wanted.transport = zmq_hosts(context);
    wanted.log = [bounded = log](const LogEntry& entry) { (*bounded)(entry); };
    return wanted;
}

void Host::Service::tell_left_out(Time now) {
    for (const LogEntry& line : log->left_out(now)) options.log(line);
}

Host::Service::Service(Options given_options, const Registry& kinds)
    : log(std::make_shared<BoundedLog>(std::move(given_options.log))),
      options(ready(std::move(given_options))),
      registry(kinds),
      cache(options.cache.empty() ? default_cache_folder() : options.cache, options.cache_size),
      rights(options.allow, options.launcher_key),
      door(*options.transport, door_options()) {
    if (!options.places) options.places = static_cast<std::uint32_t>(machine.cores);
    options.log = [this, tell = std::move(options.log)](LogEntry entry) {
        if (run && !entry.run) entry.run = run->id();
        tell(entry);
    };
    cache.trim();
}

Host::Host(Options options, const Registry& registry)
    : service_(std::make_unique<Service>(std::move(options), registry)) {}
Host::~Host() = default;
DaemonFigures Host::figures() const { return service_->shown.read(); }
std::string Host::endpoint() const { return service_->door.endpoint(); }

void Host::serve(const std::atomic<bool>& stop) {
    auto& s = *service_;
    s.leadership->take();
    const std::unique_ptr<Leadership, void (*)(Leadership*)> led(s.leadership.get(),
                                                                 [](auto* its) { its->give_back(); });
    s.needed = Clock::now();
    int failed = 0;  // turns, one after the other
    for (bool on = true; on;) {
        try {
            on = s.turn(stop);
            failed = 0;
        } catch (const std::exception& error) {
            if (++failed == most_failed_turns) throw;
            s.survive(error);
        }
    }
    if (s.run) s.drop_run("this host is stopping");
    s.tell_left_out(Clock::now() + std::chrono::minutes(2));  // all that there is to tell
}

// False: it has ended.
bool Host::Service::turn(const std::atomic<bool>& stop) {
    const auto now = Clock::now();
    if (stop && (!leaving || !leaving->for_good)) leave(now, true);
    if (leaving && gone(now)) {
        if (leaving->for_good) return false;
        if (run) drop_run("it was told to leave it");
        leaving.reset();
    }
    const auto readable = wait();
    if (readable.replies) traffic.send();
    if (readable.door) {
        door.let_in();
        while (auto arrival = traffic.receive(Clock::now())) arrived(std::move(*arrival));
    }
    if (run && door.tally().heard > lease.last_heard()) lease.heard(door.tally().heard);
    look_at_arriving();
    look_at_ending();
    door.go_on(now);
    if (readable.gateway) forward_asks();
    if (peers && (readable.peers || peers->due(now))) peers->tick(now);
    if (readable.news || (run && !run->serving())) advance();
    if (readable.news) tell_failures();
    if (run) run->results().go_on(now);
    if (rights.owner_is_gone(now, options.log)) drop_owner();
    if (run && lease.is_over(now)) drop_run("its launcher is silent");
    if (!leaving) door.keep_in_touch(now);
    if (run) needed = now;
    if (!run) last_scene.wait(now);
    show_figures(now);
    tell_left_out(now);
    if (options.patience && now - needed > *options.patience) {
        options.log("nobody needs it any more");
        return false;
    }
    return true;
}

// What finds no memory, or a call of the system's that fails, costs the run: what it was at may be half done.
void Host::Service::survive(const std::exception& error) {
    const auto why = words_of(error);
    if (!run) return options.log({LogLevel::warning, "something was left undone: " + why});
    door.send(launcher, Type::broken, run->id(), Fields{}.set("text", why));
    drop_run(why);
}

bool Host::hangs() const { return !service_->background.done_within(goodbye_deadline); }

void Host::Service::arrived(PlaceTraffic::Arrival arrival) {
    auto& [frames, key] = arrival;
    const auto route = text_of(frames[0]);
    if (frames.size() == 2 && frames[1].size() == 0) {  // what went through the launcher may be lost
        if (gateway && route == launcher) gateway->request_resend("");
        return;
    }
    if (frames.size() < 3) return damaged(route);
    const auto header_bytes = bytes_of(frames[frames.size() - 2]);
    const auto header = packet::peek_header(header_bytes);
    const bool plain = frames.size() == 3;
    if (header && !rights.may(key, header->type, run && header->run == run->id())) {
        ++broken_packets;
        return;
    }
    if (header && frames.size() == 4 && (header->type < Type::hello || header->type == Type::fetch))
        return from_another(*header, std::move(frames));
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
        if (run && header->run == run->id()) lease.heard(Clock::now());
        if (piece)
            take_blob(route, header->run, *piece);
        else
            control({route, key}, *header, *fields);
    } catch (const std::exception& error) {
        door.send(route, Type::broken, header->run, Fields{}.set("text", words_of(error)));
        if (run && run->id() == header->run) drop_run(words_of(error));
    }
}

// Whoever sent it must send it again.
void Host::Service::damaged(const std::string& route) {
    ++broken_packets;
    Frames resend;
    resend.emplace_back(route);
    resend.emplace_back();
    door.send(resend);
}

// [route][address][header][body]: an ask through the launcher, or the reply to one of ours; or another host asks for a
// result.
void Host::Service::from_another(const packet::Header& header, Frames frames) {
    if (packet::is_ask(header.type)) return traffic.ask(header, std::move(frames));
    if (!run || header.run != run->id()) return;
    if (header.type == Type::fetch) return run->results().asked(std::move(frames));
    const auto address = unseal(bytes_of(frames[1]));
    frames.erase(frames.begin(), frames.begin() + 2);
    if (!address || !gateway->forward(address->place, frames)) gateway->request_resend("");
}

void Host::Service::advance() {
    if (!run) return;
    try {
        while (run->advance()) {
            if (run->state() == HostedRun::State::fetching) tell_needs();
            if (run->state() == HostedRun::State::building && run->has_last_scene())
                options.log("has its scene from the run before");
            if (!run->serving()) continue;
            traffic.serve(run->id(), run->transport());
            door.send(launcher, Type::ready, run->id(), {});
        }
    } catch (const std::exception& error) {
        door.send(launcher, Type::broken, run->id(), Fields{}.set("text", words_of(error)));
        drop_run(words_of(error));
    }
}

void Host::Service::forward_asks() {
    if (!gateway) return;
    while (auto frames = gateway->receive()) peers->ask(std::move(*frames));
}

// For hosts that we can't call: the launcher passes it on.
void Host::Service::forward_to_launcher(Frames& frames) {
    const auto place = text_of(frames[0]), host = text_of(frames[1]);
    frames[0] = MessageFrame(launcher);
    frames[1] = MessageFrame(seal({host, place}));
    door.send(frames);  // if it fails the launcher greets us anew, and all is sent again
}

void Host::Service::tell_failures() {
    if (!run) return;
    for (const auto& [why, host, lie] : run->failures()) {
        options.log({LogLevel::error,
                     lie ? "somebody has answered falsely: " + why : host + " failed at what it was asked: " + why});
        door.send(launcher, Type::fault, run->id(), Fields{}.set("host", host).set("text", why).set("lie", lie));
    }
}

void Host::Service::leave(Clock::time_point now, bool for_good) {
    if (leaving) {  // the run alone, so far
        leaving->for_good = true;
        return;
    }
    leaving = Leaving{now, false, std::nullopt, for_good};
    if (!run) return;
    options.log(for_good ? "finishes what it has, then stops" : "finishes what it has of this run");
    door.send(launcher, Type::leaving, run->id(), Fields{}.set("text", for_good ? options.why_told() : ""));
    if (run->serving()) return;
    drop_run("this host is stopping");
    leaving->farewell = now;
}

bool Host::Service::gone(Clock::time_point now) {
    const bool said = !door.waiting() || now - leaving->since > options.drain;
    if (leaving->farewell) return !run && said && now - *leaving->farewell > goodbye_deadline;
    if (!run) return !ended.ending() || now - leaving->since > goodbye_deadline;
    if (now - leaving->since > options.drain) return true;
    const auto last_work = std::max(leaving->since, traffic.last_work());
    const bool idle = traffic.is_idle() && !door.waiting() && now - last_work > quiet_before_leaving;
    if (!leaving->known || !idle) return false;
    end(launcher, run->id());
    leaving->farewell = now;
    return false;
}

// Leaves the door and the traffic of places to these, if they idle. True: a turn is due.
bool Host::Service::rest(Time now) {
    if (!run || !run->serving() || leaving || !leadership->wanted(now)) return false;
    const auto others = [&](Poll& poll) {
        poll.add(background.handle());
        door.watch(poll, HostDoor::Watched::callers);
        peers->watch(poll);
        gateway->watch(poll);
        poll.add(run->news());
        poll.add(run->places()->news());
    };
    return leadership->rest(others, run->transport()->replies(), turn_interval) != Leadership::Rest::lapsed;
}

Host::Service::Readable Host::Service::wait() {
    const bool due = rest(Clock::now());
    Poll poll;
    door.watch(poll, HostDoor::Watched::all);
    const std::size_t background_item = poll.size();
    poll.add(background.handle());
    if (peers) peers->watch(poll);
    const std::size_t gateway_item = poll.size();
    auto* const places = run ? run->places() : nullptr;
    if (run) {
        gateway->watch(poll);
        poll.add(run->news());
    }
    if (places) poll.add(places->news());
    const std::size_t first_place = poll.size();
    if (places && run->serving()) poll.add(run->transport()->replies());
    const bool soon = leaving || (peers && peers->waiting());
    poll.wait(due ? std::chrono::milliseconds(0) : soon ? std::chrono::milliseconds(5) : turn_interval);
    Readable readable;
    readable.door = traffic.has_left() || poll.any_readable(0, background_item);
    if (poll.readable(background_item)) background.clear();
    if (!run) return readable;
    readable.peers = poll.any_readable(background_item + 1, gateway_item);
    readable.gateway = poll.readable(gateway_item);
    readable.news = poll.any_readable(gateway_item + 1, first_place);
    if (readable.news) run->clear_news();
    readable.replies = poll.any_readable(first_place, poll.size());
    return readable;
}

}  // namespace lightnet
