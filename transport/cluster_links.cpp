#include "transport/cluster_links.hpp"

#include <zmq.hpp>

#include "core/base/error.hpp"
#include "core/run/runtime/fingerprint.hpp"
#include "transport/descriptors.hpp"
#include "transport/relay.hpp"

namespace lightnet {
namespace {

constexpr std::size_t most_hosts = 4096;

Told told_of(const Cluster::Options& options) {
    Told told{options.run, options.who, options.job.isa, fingerprint(options.job.isa), to_json(options.job), {}};
    for (const auto& file : options.job.files) told.blobs[file.hash] = options.files.at(file.path);
    return told;
}

}  // namespace

Cluster::Links::Links(Options given)
    : options(std::move(given)), told(told_of(options)), its_context(make_context()), context(*its_context) {
    plan.places_of.resize(options.job.graph.nodes.size());
    constexpr std::size_t per_host = 4;  // two sockets with a connection each
    want_descriptors(per_host * options.endpoints.size(),
                     "a run on " + std::to_string(options.endpoints.size()) + " hosts");
    if (!options.listen.empty())
        joiners.emplace(context, options.listen, Pass::of(options.pass.empty() ? Pass::usual_file() : options.pass));
    for (const auto& endpoint : options.endpoints) call(endpoint);
    if (options.threads)
        own = std::make_unique<OwnPlaces>(context, options.network, options.run, options.threads,
                                          options.plan({{"", options.threads}}), options.job.tuning);
}

Cluster::Links::~Links() = default;

std::vector<HostOffer> Cluster::Links::offers(bool ready_only) const {
    std::vector<HostOffer> offers;
    if (own_ready || (own && !ready_only)) offers.push_back({"", own->count()});
    for (const auto& link : links) {
        const auto state = link->state();
        const bool greeted = state == State::greeted || state == State::sending || state == State::building;
        if (state == State::ready || (!ready_only && greeted)) offers.push_back({link->name(), link->places()});
    }
    return offers;
}

Plan Cluster::Links::plan_for(const std::vector<HostOffer>& there) const {
    Plan made;
    made.places_of.resize(options.job.graph.nodes.size());
    if (!there.empty()) made = options.plan(there);
    for (const auto& link : links)
        for (std::uint32_t place = 0; link->state() == State::leaving && place < places_before(*link); ++place)
            made.places.push_back({link->name(), place});
    for (const auto& link : links)
        if (link->process()) made.processes[link->name()] = link->process();
    return made;
}

void Cluster::Links::look() {
    const auto now = Clock::now();
    take_joiners(now);
    const auto expected_plan = [&]() -> std::optional<std::string> {
        if (now < hold_until && absent()) return std::nullopt;
        return to_json(plan_for(offers(false)));
    };
    const HostLink::Takers takers{[&](Message message) { arrived.push_back(std::move(message)); },
                                  [&](HostLink& from, Frames& frames) { relays.pass_on(from.name(), frames); }};
    for (auto& link : links) {
        // What has come counts before the lease is looked at: we may have been busy ourselves.
        while (link->receive(now, takers)) {
        }
        link->tick(now, expected_plan);
        if (const auto counted = link->take_ended()) ended += *counted;
    }
    look_at_own();
    relays.say_again(now);
    for (auto& link : links)
        for (const auto& failure : link->take_failures())
            take_out(failure.host, failure.why + " (" + link->name() + " had asked it)");
    tell_changes();
}

bool Cluster::Links::take_out(const std::string& name, const std::string& why) {
    auto* link = find(name);
    if (!link || link->state() == State::refused) return link;
    const auto ready = offers(true);
    if (std::all_of(ready.begin(), ready.end(), [&](const auto& offer) { return offer.endpoint == name; }))
        return false;
    link->take_out(why);
    return true;
}

void Cluster::Links::wait(std::chrono::nanoseconds most) {
    std::vector<zmq::socket_t*> sockets;
    std::vector<zmq_pollitem_t> items;
    bool soon = relays.waiting();
    for (auto& link : links) {
        soon |= link->state() == State::sending;
        for (auto* socket : link->line().sockets()) sockets.push_back(socket);
    }
    const auto add = [&](const std::vector<zmq::socket_t*>& more) {
        sockets.insert(sockets.end(), more.begin(), more.end());
    };
    if (joiners) add(joiners->sockets());
    if (own) {
        add(own->sockets());
        items.push_back(readable(own->news()));
    }
    for (auto* socket : sockets) items.push_back(readable(*socket));
    const auto ms = std::clamp(std::chrono::ceil<std::chrono::milliseconds>(most), std::chrono::milliseconds(1),
                               std::chrono::milliseconds(soon ? 5 : 100));
    poll(items, ms);
}

void Cluster::Links::take_joiners(Clock::time_point now) {
    if (!joiners) return;
    const Joiners::Takers takers{
        [&](const std::string& endpoint) {
            if (links.size() < most_hosts) call(endpoint);
        },
        [&](const std::string& name, std::unique_ptr<JoinedLine> line) { add(name, std::move(line)); },
        [&](const std::string& name, const std::string& why) {
            if (auto* link = find(name)) link->lose(now, why);
        },
        [&] { return hosts(); },
        [&](const std::string& name, const std::string& address) {
            if (turned_down.size() < most_hosts && turned_down.insert(name + " " + address).second)
                options.say(name + " (" + address +
                            ") wants to join, but does not know the pass of this run's user (--pass)");
        }};
    counters.broken_packets += joiners->receive(takers);
}

Relays::Ways Cluster::Links::ways() {
    return {[this](const std::string& to, Frames& frames, std::uint32_t place) {
                if (to.empty()) return own && own->pass_ask(frames, place);
                auto* link = find(to);
                return link && link->takes_part() && link->pass(frames);
            },
            [this](const RelayAddress& asker, Frames& frames) {
                auto* link = find(asker.host);
                if (!asker.host.empty()) return !link || !link->takes_part() || link->pass(frames);
                frames.erase(frames.begin());
                return own && own->pass_reply(asker.place, frames);
            },
            [this](const std::string& host) {
                auto frames = empty_message();
                if (host.empty() && own) own->say_again("");
                if (auto* link = find(host); link && link->takes_part()) link->pass(frames);
            },
            [this] {
                relays.must_say_again("");
                for (const auto& link : links) relays.must_say_again(link->name());
            }};
}

void Cluster::Links::look_at_own() {
    if (!own) return;
    for (const auto& failure : own->failures()) take_out(failure.host, failure.why);
    if (own->ready() && !std::exchange(own_ready, true)) options.say("places of this process are ready");
    own->receive({[&](Message message) { arrived.push_back(std::move(message)); },
                  [&](Frames& frames) {
                      Frames packet;
                      packet.push_back(frame_of(seal({text_of(frames[1]), text_of(frames[0])})));
                      for (auto i : {2, 3}) packet.push_back(std::move(frames[static_cast<std::size_t>(i)]));
                      relays.pass_on("", packet);
                  },
                  [&](Frames& frames) {
                      if (frames.size() == 3) relays.pass_on("", frames);
                  }});
}

void Cluster::Links::tell_changes() {
    bool changed = own_ready && !states.contains("");
    if (changed) states[""] = State::ready;
    for (auto& link : links) {
        const auto before = states.contains(link->name()) ? states[link->name()] : State::calling;
        const auto state = states[link->name()] = link->state();
        if (state == before) continue;
        const bool was_there = before == State::ready || before == State::leaving;
        if (state == State::ready) options.say(link->name() + " is ready");
        if (link->takes_part() && !in_force.empty()) link->send_plan(in_force);
        if (state == State::refused)
            options.say(link->name() + (was_there ? " is taken out: " : " takes no part: ") + link->reason());
        if (state == State::leaving) options.say(link->name() + " was told to stop: it finishes what it has");
        if (before == State::leaving) options.say(link->name() + " has left");
        if (before == State::ready && state == State::calling)
            options.say(link->name() + " is lost: " + link->reason() + "; its work is asked again elsewhere");
        changed |= state == State::ready || was_there;
    }
    if (!changed) return;
    plan = plan_for(offers(true));
    Message message;
    message.type = Message::Type::plan;
    message.run = options.run;
    message.plan = std::make_shared<const Plan>(plan);
    arrived.push_back(std::move(message));
}

std::vector<HostState> Cluster::Links::hosts() const {
    std::vector<HostState> hosts;
    if (own) hosts.push_back({"", "is ready", true, own->count(), own->progress(), this_machine()});
    for (const auto& link : links)
        hosts.push_back(
            {link->name(), link->words(), link->takes_part(), link->places(), link->progress(), link->machine()});
    return hosts;
}

std::string Cluster::Links::reasons() const {
    std::string text;
    for (const auto& name : options.expected)
        if (!find(name)) text += "\n  " + name + ": has not joined at " + joiners->endpoint();
    for (const auto& link : links) text += "\n  " + link->name() + ": " + link->trouble();
    return text.empty() && joiners ? "\n  nobody has joined at " + joiners->endpoint() : text;
}

void Cluster::Links::say_what_is_missing(Clock::duration waited) const {
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(waited).count();
    std::string whom;
    for (const auto& name : options.expected)
        if (!find(name)) whom += "\n  " + name + ": has not joined";
    for (const auto& link : links)
        if (link->state() == State::calling || link->busy() || link->pending())
            whom += "\n  " + link->name() + ": " + link->trouble();
    if (whom.empty() && links.empty() && joiners) whom = "\n  somebody to join";
    if (!whom.empty()) options.say("waiting for " + std::to_string(seconds) + " s:" + whom);
}

bool Cluster::Links::absent() const {
    return std::any_of(options.expected.begin(), options.expected.end(),
                       [&](const auto& name) { return !find(name); }) ||
           std::any_of(links.begin(), links.end(), [](const auto& link) { return link->state() == State::calling; });
}

HostWait::Standing Cluster::Links::standing() const {
    HostWait::Standing all{own_ready, own && !own_ready, absent(), false, links.empty() || joiners};
    for (const auto& link : links) {
        all.ready |= link->state() == State::ready;
        all.busy |= link->busy();
        all.pending |= link->pending();
    }
    return all;
}

}  // namespace lightnet
