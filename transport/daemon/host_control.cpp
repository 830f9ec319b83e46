// Control of a host by launchers: what they say, and what it does.
#include <algorithm>
#include <sstream>
#include <system_error>
#include <utility>
#include <vector>

#include "core/base/build_info.hpp"
#include "core/base/error.hpp"
#include "core/base/joined.hpp"
#include "core/base/own_process.hpp"
#include "core/base/this_machine.hpp"
#include "core/base/words_of.hpp"
#include "core/network/graph/plugin_use.hpp"
#include "core/run/assembly/fingerprint.hpp"
#include "transport/daemon/host_service.hpp"
#include "transport/places/descriptors.hpp"

namespace lightnet {
namespace {

constexpr std::uint32_t most_places = 256;   // that a hosts file may ask for, if this host does not offer more itself
constexpr std::size_t for_other_work = 128;  // descriptors

using packet::Fields;
using packet::Type;

// Each takes a descriptor for the socket and one for the connection. Those that there are already count as well.
bool may_have_own_lines(std::size_t lines, std::size_t most) {
    return lines <= most && (lines == 0 || descriptors_left() > for_other_work);
}

// Names, as many as anybody needs.
std::vector<std::string> lines_of(const std::string& text) {
    constexpr std::size_t most = 16;
    std::vector<std::string> lines;
    std::istringstream in(text);
    for (std::string line; lines.size() < most && std::getline(in, line);)
        if (!line.empty()) lines.push_back(line);
    return lines;
}

}  // namespace

void Host::Service::control(const PacketSender& sender, const packet::Header& header, const Fields& fields) {
    const bool ours = run && header.run == run->id();
    const auto& route = sender.route;
    switch (header.type) {
        case Type::hello:
            return greet(route, fields);
        case Type::begin:
            return begin(sender, header.run, fields);
        case Type::ping:
            return door.send(route, Type::pong, header.run, answer_to_ping(fields, ours));
        case Type::plan:
            if (ours) use(plan_from_json(fields.text("plan")));
            if (ours && leaving) leaving->known = true;
            return;
        case Type::leaving:
            if (ours && !leaving) leave(std::chrono::steady_clock::now(), false);
            return;
        case Type::members:
            if (ours) rights.use_members(AllowList::parse_what_can_be(fields.text("members")));
            if (ours) peers->hear(fields.text("numbers"));
            return;
        case Type::status:
            return tell_state(sender);
        case Type::expect:
            if (const auto hash = hash_from_hex(fields.text("hash")); ours && hash)
                run->expect(*hash, fields.number("size"), lines_of(fields.text("holders")));
            return;
        case Type::end:
            return end(route, header.run);
        default:
            return;
    }
}

Fields Host::Service::answer_to_ping(const Fields& ping, bool ours) {
    Fields pong;
    pong.set("process", process)
        .set("run", ours ? run->id() : 0)
        .set("sent", ping.number("sent"))
        .set("asked_at", ping.number("asked_at"))
        .set("clock", steady_nanoseconds())
        .set("line", door.tally().line)
        .set("taken", door.tally().taken)
        .set("told", door.tally().told)
        .set("progress", run && run->places() ? run->places()->progress() : 0)
        .set("pulse", ours && run->places() ? run->places()->pulse() : 0)
        .set("peak_memory", peak_memory())
        .set("doing", ours && run->places() ? to_text(run->places()->doing()) : "");
    if (!ours || !run->serving() || !ping.number("watch")) return pong;
    run->places()->watch();
    return pong.set("figures", to_text(run->places()->figures()));
}

void Host::Service::greet(const std::string& route, const Fields& fields) {
    if (leaving && options.ports.empty()) return;  // whoever comes after it may serve
    if (leaving)                                   // others of its supervisor may serve at once
        return door.send(route, Type::refuse, 0,
                         Fields{}.set("text", "it stops").set("busy", 1).set("ports", options.ports));
    if (fields.text("build") != build_id())
        return door.send(
            route, Type::refuse, 0,
            Fields{}.set("text", "builds differ: it runs " + build_id() + ", the launcher " + fields.text("build")));
    try {
        Fields answer;
        set(answer, machine);
        answer.set("places", options.places)
            .set("process", process)
            .set("fingerprint", fingerprint(fields.text("isa")));
        door.send(route, Type::welcome, 0, answer);
    } catch (const Error& error) {  // a processor without that instruction set
        door.send(route, Type::refuse, 0, Fields{}.set("text", error.what()));
    }
}

std::string Host::Service::busy_with() const {
    if (!run && ended.ending()) return "it still ends the run before";
    return "it serves another run" + (who.empty() || rights.asks_for_keys() ? "" : ", of " + who);
}

void Host::Service::refuse(const std::string& route, std::uint64_t id, const std::string& why) {
    LogEntry refused(LogLevel::warning, "refuses a run: " + why);
    refused.run = id;
    options.log(refused);
    door.send(route, Type::broken, id, Fields{}.set("text", why));
}

void Host::Service::begin(const PacketSender& sender, std::uint64_t id, const Fields& fields) {
    if (leaving) return;
    const auto& route = sender.route;
    auto members = AllowList::parse_what_can_be(fields.text("members"));
    if (run && run->id() == id) {
        rights.use_members(std::move(members));
        peers->hear(fields.text("numbers"));
        return go_on(route, plan_from_json(fields.text("plan")));
    }
    if (arriving && arriving->id == id && arriving->sender.key == sender.key) {
        arriving->sender.route = route;
        return;
    }
    if (run || arriving || ended.ending())
        return door.send(route, Type::refuse, id,
                         Fields{}.set("text", busy_with()).set("busy", 1).set("ports", options.ports));
    if (const auto size = fields.text("job").size() + fields.text("plan").size(); size > most_job_bytes)
        return refuse(route, id, "a job of " + std::to_string(size) + " bytes is larger than any that is taken");
    auto read = background.start([job = fields.text("job"), plan = fields.text("plan"), this] {
        ArrivingJob::Content content{read_job(job, registry), plan_from_json(plan)};
        if (!fits(content.plan, content.job.graph)) throw Error("the plan does not fit the graph");
        return content;
    });
    arriving = ArrivingJob{id,
                           sender,
                           fields.text("you"),
                           fields.text("who"),
                           std::move(members),
                           fields.text("numbers"),
                           std::move(read)};
}

void Host::Service::look_at_arriving() {
    if (!arriving || !arriving->is_read()) return;
    auto job = std::move(*arriving);
    arriving.reset();
    try {
        start(job, job.content.get());
    } catch (const std::exception& error) {
        refuse(job.sender.route, job.id, words_of(error));
        if (run && run->id() == job.id) drop_run(words_of(error));
    }
}

void Host::Service::start(const ArrivingJob& job, ArrivingJob::Content read) {
    if (leaving) return;
    // a hosts file may ask for more places than there are cores
    const auto mine = places_of_host(read.plan, job.you);
    const auto offered = std::max(options.places, most_places);
    if (mine > offered)
        throw Error("the plan asks for " + std::to_string(mine) + " places of this host, which gives at most " +
                    std::to_string(offered));
    const auto places = std::max(options.places, mine);
    const auto most = std::size_t{read.job.tuning.own_lines};
    const auto lines = std::make_shared<LineBook>();
    HostedRun::Assignment assignment{job.id, job.you, places, read.plan, std::move(read.job)};
    run = std::make_unique<HostedRun>(context, cache, registry, last_scene, std::move(assignment),
                                      ShortWays{lines, leadership});
    rights.serve(job.sender.key);
    rights.use_members(job.members);
    gateway.emplace(*context, job.id);
    peers.emplace(*options.transport, job.you,
                  PeerConnections::Handlers{[this](const std::string& host, const std::string& place, Frames& frames) {
                                                if (place.empty()) return run->results().arrived(host, frames);
                                                gateway->forward(place, frames);
                                            },
                                            [this](const std::string& host) {
                                                gateway->request_resend(host);
                                                run->results().lose(host);
                                            },
                                            [this](Frames& frames) { forward_to_launcher(frames); },
                                            [this](const std::string& host) { return keys_to(host); },
                                            [=](LineBook::Entries quick, std::size_t hosts) {
                                                if (!may_have_own_lines(hosts * places, most)) quick.clear();
                                                for (auto& [host, entry] : quick) entry.room /= places;
                                                lines->use(std::move(quick));
                                            }},
                  options.line_life);
    peers->hear(job.numbers);
    run->results().connect(
        {job.id, [this](Type type, const Fields& said) { door.send(launcher, type, run->id(), said); },
         [this](auto hosts) { return peers->nearest(std::move(hosts)); },
         [this](Frames frames) { peers->ask(std::move(frames)); }, [this](Frames& frames) { door.send(frames); },
         [this](const std::string& said) {
             options.log({LogLevel::warning, said});
         }});
    who = job.who;
    forget_peak_memory();
    ++runs_begun;
    options.log("serves a run" + (who.empty() ? "" : " of " + who));
    go_on(job.sender.route, read.plan);
}

// Hosts of a run that have keys know each other by them; some have none.
std::optional<LineKeys> Host::Service::keys_to(const std::string& host) const {
    const auto theirs = rights.members().key_of(host);
    if (!options.key || !theirs) return std::nullopt;
    return LineKeys{*options.key, *theirs};
}

void Host::Service::drop_owner() {
    if (!run) return;
    const std::string why = "the key of its launcher was taken off the list";
    door.send(launcher, Type::broken, run->id(), Fields{}.set("text", why));
    drop_run(why);
}

void Host::Service::use(const Plan& plan) {
    run->use(plan);
    peers->use(plan);
}

// The launcher has begun it, or has found us again.
void Host::Service::go_on(const std::string& route, const Plan& plan) {
    launcher = route;
    door.count(route, run->id());
    lease.begin(std::chrono::steady_clock::now());
    run->expect(plan);
    peers->use(plan);
    run->expect_files_anew();
    gateway->request_resend("");
    if (run->state() != HostedRun::State::looking) tell_needs();
    if (run->serving()) door.send(route, Type::ready, run->id(), {});  // the launcher had lost sight of us
}

void Host::Service::tell_needs() {
    std::string missing;
    for (const auto& hash : run->missing()) missing += to_hex(hash);
    door.send(launcher, Type::need, run->id(), Fields{}.set("hashes", missing));
}

// Who shares this host with others is not told of their work.
void Host::Service::tell_state(const PacketSender& sender) {
    Fields fields;
    set(fields, machine);
    fields.set("name", options.name.empty() ? machine.name : options.name).set("places", options.places);
    fields.set("state", leaving          ? "leaves"
                        : run            ? run->words()
                        : ended.ending() ? "ends a run"
                                         : "is free")
        .set("who", run && rights.is_owner(sender.key) ? who : "");
    fields.set("plugins", joined(std::vector(registry.plugins().begin(), registry.plugins().end()), ", "));
    fields.set("clock", static_cast<std::uint64_t>(
                            std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch()).count()));
    fields.set("broken_packets", broken_packets).set("resident_memory", process_figures().resident);
    if (run && rights.is_owner(sender.key)) {
        fields.set("nodes", run->nodes()).set("bundles", traffic.given());
        fields.set("progress", run->places() ? run->places()->progress() : 0);
    }
    fields.set("ports", options.ports);
    door.send(sender.route, Type::state, 0, fields);
}

void Host::Service::take_blob(const std::string& route, std::uint64_t id, const packet::Piece& piece) {
    if (!run || run->id() != id) return;
    if (run->take_blob(piece))
        door.send(route, Type::blob_taken, id, Fields{}.set("hash", to_hex(piece.hash)).set("offset", piece.offset));
}

// Its threads end when they have done what they are at, which may take a while: somebody else waits for them.
void Host::Service::stop_run(const std::string& route) {
    const auto id = run->id();
    rights.serve({});
    traffic.serve(0, nullptr);
    const auto done = so_far();
    if (run->places()) answered += run->places()->progress();
    peers.reset();
    gateway.reset();
    door.drop_waiting();
    run->begin_to_stop();
    const auto over = std::make_shared<std::unique_ptr<HostedRun>>(std::move(run));
    const auto stop = [over, this] {
        auto last = std::move(*over);
        const auto counters = last->stop();
        last.reset();  // it claims what it needed no more
        cache.trim();
        return counters;
    };
    try {
        ended.begin(id, route, done, background.start(stop));
    } catch (const std::system_error&) {  // no thread is to be had
        std::promise<Counters> counters;
        counters.set_value(stop());
        ended.begin(id, route, done, counters.get_future());
    }
    look_at_ending();
}

// What isn't among the counters of runs that have ended.
PlaceThreads::SoFar Host::Service::so_far() const {
    if (run && run->places()) return run->places()->so_far();
    return ended.so_far();
}

void Host::Service::show_figures(Time now) {
    if (!shown.are_old(now)) return;
    DaemonFigures next;
    next.places = options.places;
    next.runs = runs_begun, next.answered = answered;
    next.ended = ended.sum();
    next.serves = run != nullptr, next.leaves = leaving.has_value();
    next.answered += run && run->places() ? run->places()->progress() : 0;
    next.broken_packets = broken_packets + ended.sum().broken_packets;
    next.when = now;
    const auto more = so_far();
    next.ended.rays += more.rays;
    if (next.ended.places.empty()) next.ended.places.emplace_back();
    auto& places = next.ended.places.front();
    places.lived_ns += more.lived_ns, places.waited_ns += more.waited_ns, places.idle_ns += more.idle_ns;
    shown.show(std::move(next), now);
}

void Host::Service::look_at_ending() {
    const auto over = ended.look(broken_packets);
    if (!over || over->route.empty()) return;
    const auto& counters = over->counters;
    Fields fields;
    for (const auto& [name, count] : counters.named()) fields.set(name, count);
    fields.set("places", to_text(counters.places)).set("peak_memory", peak_memory());
    if (!counters.traces.empty()) fields.set("traces", to_bytes(counters.traces));
    door.send(over->route, Type::ended, over->id, fields);
}

void Host::Service::end(const std::string& route, std::uint64_t id) {
    if (run && run->id() == id) {
        tell_failures();  // while they count
        options.log("the run has ended");
        return stop_run(route);
    }
    if (arriving && arriving->id == id) arriving.reset();
    if (ended.wanted_by(route, id)) return;
    door.send(route, Type::ended, id, {});
}

void Host::Service::drop_run(const std::string& why) {
    options.log({LogLevel::warning, "the run is given up: " + why});
    stop_run({});
}

}  // namespace lightnet
