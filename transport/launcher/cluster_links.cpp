#include "transport/launcher/cluster_links.hpp"

#include <bit>

#include "core/base/error.hpp"
#include "core/base/ip_address.hpp"
#include "core/run/assembly/fingerprint.hpp"
#include "transport/keys/key_file.hpp"
#include "transport/launcher/own_host.hpp"
#include "transport/lines/poll.hpp"
#include "transport/places/descriptors.hpp"

namespace lightnet {
namespace {

constexpr std::size_t most_hosts = 4096;

RunOffer offer_of(const Cluster::Options& options) {
    RunOffer offer{options.run, options.who, options.job.isa, fingerprint(options.job.isa), to_json(options.job), {}};
    offer.line_life = options.line_life;
    for (const auto& file : options.job.files) offer.blobs[file.hash] = options.files.at(file.path);
    return offer;
}

Pass pass_for_joiners(const Cluster::Options& options) {
    keep_secrets_out_of_dumps();
    return Pass::of(options.pass.empty() ? Pass::usual_file() : options.pass);
}

}  // namespace

Cluster::Links::Links(Options given) : options(std::move(given)), offer(offer_of(options)) {
    if (!options.warn) options.warn = options.say;
    if (!options.transport || options.threads) context = std::make_shared<const SocketContext>();
    if (!options.transport) options.transport = zmq_hosts(context);
    const auto say_so = [this](const std::string& text) { say_of_stranger(text); };
    plan.places_of.resize(options.job.graph.nodes.size());
    constexpr std::size_t per_host = 5;  // two sockets with a connection each, and what watches one
    want_descriptors(per_host * options.endpoints.size(),
                     "a run on " + std::to_string(options.endpoints.size()) + " hosts");
    if (!options.listen.empty() && options.join_keys)
        joiners.emplace(*options.transport, options.listen,
                        JoinListener::Door{options.key.value(), *options.join_keys, say_so});
    else if (!options.listen.empty())
        joiners.emplace(*options.transport, options.listen, pass_for_joiners(options));
    for (const auto& endpoint : options.endpoints) {
        const auto key = options.host_keys.find(endpoint);
        call(endpoint, key == options.host_keys.end() ? HostKey() : key->second);
    }
    if (options.threads)
        links.insert(links.begin(),
                     std::make_unique<OwnHost>(context, options.network, options.run, options.threads,
                                               options.plan({{"", options.threads}}), options.job.tuning));
}

void Cluster::Links::call(const std::string& endpoint, const HostKey& key) {
    if (find(endpoint)) return;
    const auto keys = key ? std::optional(LineKeys{options.key.value(), *key}) : std::nullopt;
    add(endpoint, std::make_unique<CalledConnection>(*options.transport, endpoint, keys), key);
}

// Others are told its key before it can ask them anything.
void Cluster::Links::add(const std::string& name, std::unique_ptr<HostConnection> connection, const HostKey& key) {
    links.push_back(std::make_unique<RemoteHost>(offer, counters, name, std::move(connection)));
    if (options.liars.contains(name)) return void(links.back()->take_out("it has answered falsely"));
    if (!key) return;
    members.add(*key, name);
    offer.members = members.text();
    for (auto& link : links) link->tell_members();
}

void Cluster::Links::tell_numbers() {
    std::string numbers;
    for (const auto& link : links) {
        const auto name = tcp_endpoint(link->name()), at = tcp_endpoint(link->answering_at());
        if (name && at && name->host != at->host) numbers += name->host + " " + at->host + "\n";
        if (name && at && name->port != at->port) numbers += link->name() + " " + at->port + "\n";
    }
    if (std::exchange(offer.numbers, numbers) == numbers) return;
    for (auto& link : links) link->tell_members();
}

bool Cluster::Links::all_unknown() const {
    return !links.empty() && std::all_of(links.begin(), links.end(), [](const auto& link) { return link->unknown(); });
}

std::vector<HostOffer> Cluster::Links::offers(bool ready_only) const {
    std::vector<HostOffer> offers;
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
        if (expected.hold(now) && absent()) return std::nullopt;
        return to_json(plan_for(offers(false)));
    };
    const HostLink::Handlers handlers{[&](Message message) { arrived.push_back(std::move(message)); },
                                      [&](HostLink& from, Frames& frames) { relays.forward(from.name(), frames); }};
    for (auto& link : links) {
        // What has come counts before the lease is looked at: we may have been busy ourselves.
        while (link->receive(now, handlers)) {
        }
        if (watched) link->watch_places();
        link->tick(now, expected_plan);
        if (const auto counted = link->take_ended()) ended += *counted;
    }
    relays.request_resends(now);
    for (auto& link : links)
        for (const auto& failure : link->take_failures())
            failure.lie ? doubt(failure, link->name()) : void(take_out(failure.host, failure.why));
    tell_changes();
    if (expected.waited_for()) expected.look(standing(), now);
}

bool Cluster::Links::take_out(const std::string& name, const std::string& why) {
    auto* link = find(name);
    if (!link) return false;
    if (link->state() == State::refused) return true;
    if (others_are_ready(name)) return link->take_out(why);
    if (!expected.may_come(standing(), Clock::now()) || !link->take_out(why)) return false;
    expected.wait_for_others(why);
    return true;
}

bool Cluster::Links::others_are_ready(const std::string& name) const {
    const auto ready = offers(true);
    return std::any_of(ready.begin(), ready.end(), [&](const auto& one) { return one.endpoint != name; });
}

// A host that accuses the only other one may be the liar itself.
void Cluster::Links::doubt(Failure found, const std::string& accuser) {
    if (!find(found.host) || (!accuser.empty() && offers(true).size() < 3)) found.host.clear();
    if (!lie) lie = std::move(found);
}

void Cluster::Links::wait(std::chrono::nanoseconds most) {
    Poll poll;
    bool soon = relays.waiting();
    for (auto& link : links) {
        soon |= link->state() == State::sending;
        link->watch(poll);
    }
    if (joiners) joiners->watch(poll);
    poll.wait(std::clamp(std::chrono::ceil<std::chrono::milliseconds>(most), std::chrono::milliseconds(1),
                         std::chrono::milliseconds(soon ? 5 : 100)));
}

void Cluster::Links::take_joiners(Clock::time_point now) {
    if (!joiners) return;
    const JoinListener::Handlers handlers{
        [&](const std::string& endpoint, const HostKey& key) {
            if (links.size() < most_hosts) call(endpoint, key);
        },
        [&](const std::string& name, std::unique_ptr<JoinedConnection> connection, const HostKey& key) {
            add(name, std::move(connection), key);
        },
        [&](const std::string& name, const std::string& why) {
            if (auto* link = find(name)) link->lose(now, why);
        },
        [&] { return hosts(); },
        [&](const std::string& name, const std::string& address) {
            if (turned_down.size() < most_hosts && turned_down.insert(name + " " + address).second)
                say_of_stranger(name + " (" + address +
                                ") wants to join, but does not know the pass of this run's user (--pass)");
        }};
    counters.broken_packets += joiners->receive(handlers);
}

Relays::Handlers Cluster::Links::relay_handlers() {
    const auto taking_part = [this](const std::string& name) {
        auto* link = find(name);
        return link && link->takes_part() ? link : nullptr;
    };
    return {[=](const std::string& to, Frames& frames, std::uint32_t place) {
                auto* link = taking_part(to);
                return link && link->forward_ask(frames, place);
            },
            [=](const RelayAddress& asker, Frames& frames) {
                auto* link = taking_part(asker.host);
                return !link || link->forward_reply(asker, frames);
            },
            [=](const std::string& host) {
                if (auto* link = taking_part(host)) link->request_resend();
            },
            [this] {
                for (const auto& link : links) relays.must_resend(link->name());
            }};
}

void Cluster::Links::tell_changes() {
    bool changed = false;
    for (auto& link : links)
        if (link->unknown() && unknown.insert(link->name()).second)
            options.say(link->name() + " takes no part: " + link->reason());
    for (auto& link : links) {
        const auto before = states.contains(link->name()) ? states[link->name()] : State::calling;
        const auto state = states[link->name()] = link->state();
        if (state == before) continue;
        const bool was_there = before == State::ready || before == State::leaving;
        if (state == State::ready) options.say(link->ready_words());
        if (state == State::ready) link->tell_members();  // they may have changed since it was begun with
        if (link->takes_part() && in_force) link->use(*in_force);
        if (state == State::refused)
            options.say(link->name() + (was_there ? " is taken out: " : " takes no part: ") + link->reason());
        if (state == State::leaving)
            options.say(link->name() + " was told to stop" + (link->reason().empty() ? "" : ", as " + link->reason()) +
                        ": it finishes what it has");
        if (before == State::leaving) options.say(link->name() + " has left");
        if (before == State::ready && state == State::calling) tell_loss(*link);
        changed |= state == State::ready || was_there;
    }
    if (!options.moved() && !changed) return;
    tell_numbers();
    plan = plan_for(offers(true));
    Message message;
    message.type = Message::Type::plan;
    message.run = options.run;
    message.plan = std::make_shared<const Plan>(plan);
    arrived.push_back(std::move(message));
}

void Cluster::Links::tell_loss(const HostLink& link) {
    const auto elsewhere = !offers(true).empty();
    options.say(link.name() + " is lost: " + link.reason() +
                (elsewhere ? "; its work is asked again elsewhere" : "; its work waits until a host is there"));
    const auto times = ++losses[link.name()];
    if (times > 1 && std::has_single_bit(times))
        options.warn(link.name() + " was lost " + std::to_string(times) + " times (" + link.reason() +
                     "), and what it had is asked again each time, in smaller pieces: its line is cut, or too busy for "
                     "others to get through, or its machine is");
}

void Cluster::Links::say_of_stranger(const std::string& text) {
    const auto now = Clock::now();
    if (strangers.may_be_said("", now)) options.say(text);
    for (const auto& [kind, count] : strangers.left_out(now))
        options.say("… and " + std::to_string(count) + " more who want to get in");
}

std::vector<HostState> Cluster::Links::hosts() const {
    std::vector<HostState> hosts;
    for (const auto& link : links)
        hosts.push_back({link->name(), link->words(), link->takes_part(), link->places(), link->progress(),
                         link->machine(), link->figures(), link->peak_memory()});
    return hosts;
}

std::string Cluster::Links::reasons() const {
    std::string text;
    for (const auto& name : options.expected)
        if (!find(name)) text += "\n  " + name + ": has not joined at " + joiners->endpoint();
    for (const auto& link : links) text += "\n  " + link->title() + ": " + link->trouble();
    return text.empty() && joiners ? "\n  nobody has joined at " + joiners->endpoint() : text;
}

void Cluster::Links::say_what_is_missing(Clock::duration waited) const {
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(waited).count();
    std::string whom;
    for (const auto& name : options.expected)
        if (!find(name)) whom += "\n  " + name + ": has not joined";
    for (const auto& link : links)
        if (link->state() == State::calling || link->busy() || link->pending())
            whom += "\n  " + link->title() + ": " + link->trouble();
    if (whom.empty() && links.empty() && joiners) whom = "\n  somebody to join";
    if (!whom.empty()) options.say("waiting for " + std::to_string(seconds) + " s:" + whom);
}

bool Cluster::Links::absent() const {
    return std::any_of(options.expected.begin(), options.expected.end(),
                       [&](const auto& name) { return !find(name); }) ||
           std::any_of(links.begin(), links.end(),
                       [](const auto& link) { return link->state() == State::calling && !link->unknown(); });
}

HostWait::Standing Cluster::Links::standing() const {
    HostWait::Standing all{false, false, absent(), false, links.empty() || joiners, false};
    for (const auto& link : links) {
        all.ready |= link->state() == State::ready;
        all.busy |= link->busy();
        all.pending |= link->pending();
        all.files_arrive |= link->state() == State::sending;
    }
    return all;
}

}  // namespace lightnet
