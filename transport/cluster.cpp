#include "transport/cluster.hpp"

#include <algorithm>
#include <deque>
#include <set>
#include <zmq.hpp>

#include "core/error.hpp"
#include "core/runtime/fingerprint.hpp"
#include "transport/descriptors.hpp"
#include "transport/host_link.hpp"
#include "transport/joiners.hpp"
#include "transport/own_places.hpp"
#include "transport/relays.hpp"
#include "transport/sockets.hpp"

namespace lightnet {
namespace {

using Clock = std::chrono::steady_clock;
using State = HostLink::State;

constexpr std::size_t most_hosts = 4096;
constexpr auto first_words_after = std::chrono::seconds(2), shortest_pause = std::chrono::seconds(5), longest_pause = std::chrono::seconds(60);

Told told_of(const Cluster::Options& options) {
    Told told{options.run, options.who, options.job.isa, fingerprint(options.job.isa), to_json(options.job), {}};
    for (const auto& file : options.job.files) told.blobs[file.hash] = options.files.at(file.path);
    return told;
}

// Of one that is not ready.
std::string trouble_of(const HostLink& link) {
    if (link.busy()) return "is busy: " + link.reason();
    if (!link.reason().empty()) return link.reason();
    switch (link.state()) {
        case State::sending:
            return "takes in files";
        case State::building:
            return "builds";
        case State::greeted:
            return "looks at the job";
        default:
            return "does not answer";
    }
}

std::string words_for(const HostLink& link) {
    switch (link.state()) {
        case State::calling:
            return link.reason().empty() ? "does not answer" : "is lost: " + link.reason();
        case State::greeted:
            return link.reason().empty() ? "is greeted" : "is busy: " + link.reason();
        case State::sending:
            return "takes in files";
        case State::building:
            return "builds";
        case State::ready:
            return "is ready";
        case State::leaving:
            return "leaves";
        case State::refused:
            return "takes no part: " + link.reason();
    }
    return {};
}

}  // namespace

struct Cluster::Links {
    Options options;
    Told told;
    std::unique_ptr<zmq::context_t> its_context = make_context();
    zmq::context_t& context = *its_context;
    std::optional<Joiners> joiners;  // hosts that dial in
    std::vector<std::unique_ptr<HostLink>> links;
    std::unique_ptr<OwnPlaces> own;
    bool own_ready = false;
    std::map<std::string, State> states;  // as last told
    Plan plan;                            // proposed
    std::string in_force;                 // the plan that hosts are to go by, as text
    std::deque<Message> arrived;
    std::set<std::string> turned_down;  // who wanted to join
    Counters counters, ended;
    Relays relays{counters, ways()};
    Clock::time_point hold_until{};  // nobody begins before all are greeted: places make their nodes by the first plan

    explicit Links(Options given) : options(std::move(given)), told(told_of(options)) {
        plan.places_of.resize(options.job.graph.nodes.size());
        constexpr std::size_t per_host = 4;  // two sockets with a connection each
        want_descriptors(per_host * options.endpoints.size(),
                         "a run on " + std::to_string(options.endpoints.size()) + " hosts");
        if (!options.listen.empty())
            joiners.emplace(context, options.listen,
                            Pass::of(options.pass.empty() ? Pass::usual_file() : options.pass));
        for (const auto& endpoint : options.endpoints) call(endpoint);
        if (options.threads)
            own = std::make_unique<OwnPlaces>(context, options.network, options.run, options.threads,
                                              options.plan({{"", options.threads}}), options.job.rules);
    }

    HostLink* find(const std::string& name) const {
        for (auto& link : links)
            if (link->name() == name) return link.get();
        return nullptr;
    }
    void call(const std::string& endpoint) {
        if (!find(endpoint)) add(endpoint, std::make_unique<CalledLine>(context, endpoint));
    }
    void add(const std::string& name, std::unique_ptr<HostLine> line) {
        links.push_back(std::make_unique<HostLink>(told, counters, name, std::move(line)));
    }

    // Offers of all hosts that are at least so far, in the order in which they were named.
    std::vector<HostOffer> offers(bool ready_only) const {
        std::vector<HostOffer> offers;
        if (own_ready || (own && !ready_only)) offers.push_back({"", own->count()});
        for (const auto& link : links) {
            const auto state = link->state();
            const bool greeted = state == State::greeted || state == State::sending || state == State::building;
            if (state == State::ready || (!ready_only && greeted)) offers.push_back({link->name(), link->places()});
        }
        return offers;
    }

    // Hosts that leave hold no node any more, but are still there: their askers wait for what is under way.
    Plan plan_for(const std::vector<HostOffer>& there) const {
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
    std::uint32_t places_before(const HostLink& link) const {
        return static_cast<std::uint32_t>(std::count_if(plan.places.begin(), plan.places.end(),
                                                        [&](const auto& at) { return at.host == link.name(); }));
    }

    void look() {
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

    // The last one stays: its failures are the run's.
    bool take_out(const std::string& name, const std::string& why) {
        auto* link = find(name);
        if (!link || link->state() == State::refused) return link;
        const auto ready = offers(true);
        if (std::all_of(ready.begin(), ready.end(), [&](const auto& offer) { return offer.endpoint == name; }))
            return false;
        link->take_out(why);
        return true;
    }

    // Until something can be read.
    void wait(std::chrono::nanoseconds most) {
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

    void take_joiners(Clock::time_point now) {
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

    // ---- from host to host ------------------------------------------------------------------------------------------

    Relays::Ways ways() {
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

    void look_at_own() {
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

    // ---- who is there -----------------------------------------------------------------------------------------------

    // Hosts that became ready or are no more: a new plan is proposed, and a line said for the user.
    void tell_changes() {
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

    std::vector<HostState> hosts() const {
        std::vector<HostState> hosts;
        if (own) hosts.push_back({"", "is ready", true, own->count(), own->progress(), this_machine()});
        for (const auto& link : links)
            hosts.push_back({link->name(), words_for(*link), link->takes_part(), link->places(), link->progress(),
                             link->machine()});
        return hosts;
    }

    std::string reasons() const {
        std::string text;
        for (const auto& name : options.expected)
            if (!find(name)) text += "\n  " + name + ": has not joined at " + joiners->endpoint();
        for (const auto& link : links) text += "\n  " + link->name() + ": " + trouble_of(*link);
        return text.empty() && joiners ? "\n  nobody has joined at " + joiners->endpoint() : text;
    }

    void say_what_is_missing(Clock::duration waited) const {
        const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(waited).count();
        std::string whom;
        for (const auto& name : options.expected)
            if (!find(name)) whom += "\n  " + name + ": has not joined";
        for (const auto& link : links)
            if (link->state() == State::calling || link->busy() || link->pending())
                whom += "\n  " + link->name() + ": " + trouble_of(*link);
        if (whom.empty() && links.empty() && joiners) whom = "\n  somebody to join";
        if (!whom.empty()) options.say("waiting for " + std::to_string(seconds) + " s:" + whom);
    }

    // Somebody who is to be there from the beginning is not.
    bool absent() const {
        return std::any_of(options.expected.begin(), options.expected.end(),
                           [&](const auto& name) { return !find(name); }) ||
               std::any_of(links.begin(), links.end(),
                           [](const auto& link) { return link->state() == State::calling; });
    }

    // What the hosts are up to before the work begins.
    struct Standing {
        bool ready = false, pending = false, absent = false, busy = false;
    };
    Standing standing() const {
        Standing all;
        all.ready = own_ready;
        all.pending = own && !own_ready;
        all.absent = absent();
        for (const auto& link : links) {
            all.ready |= link->state() == State::ready;
            all.busy |= link->busy();
            all.pending |= link->pending();
        }
        return all;
    }

    // One host that can't do its part may be sick. What two hosts say in the same words is the run's own trouble, and
    // so is what keeps the only ones from serving.
    void throw_if_broken(bool nobody_left) const {
        std::map<std::string, const HostLink*> reasons;
        for (const auto& link : links) {
            if (!link->broken() || link->state() != State::refused) continue;
            const bool fresh = reasons.emplace(link->reason(), link.get()).second;
            if (!fresh || nobody_left) throw Error(link->name(), link->reason());
        }
    }
};

Cluster::Cluster(Options options) : links_(std::make_unique<Links>(std::move(options))) {}
Cluster::~Cluster() = default;

void Cluster::gather(Patience patience, const std::atomic<bool>& cancelled, const std::function<void()>& look_around) {
    const auto begun = Clock::now();
    links_->hold_until = begun + patience.absent;
    std::optional<Clock::time_point> first_ready;
    auto next_words = begun + first_words_after;
    auto pause = shortest_pause;  // grows: who waits for an hour doesn't want a thousand lines
    while (!cancelled) {
        wait(std::chrono::milliseconds(20));
        look_around();
        links_->arrived.clear();  // plans on the way here; plan() is the one that counts
        const auto now = Clock::now();
        const auto all = links_->standing();
        links_->throw_if_broken(!all.ready && !all.pending && !all.busy && !all.absent);
        const auto waited = now - begun;
        if (all.ready && !first_ready) first_ready = now;
        // Machines differ: whoever is not ready gets as long again as the first one took.
        const bool too_slow =
            first_ready && now - *first_ready > std::max<Clock::duration>(patience.slow, *first_ready - begun);
        const bool wait_for_slow = all.pending && !too_slow && (all.ready || waited < patience.build);
        const bool wait_for_absent = waited < patience.absent && (all.absent || all.busy);
        if (!wait_for_slow && !wait_for_absent) {
            if (all.ready) return;
            const bool somebody_may_come = links_->links.empty() || links_->joiners;
            if (all.pending || (!all.busy && (waited >= patience.nobody || !somebody_may_come)))
                throw NoWorker("no worker can be reached:" + links_->reasons());
        }
        if (now < next_words) continue;
        next_words = now + pause;
        if (waited > 6 * pause) pause = std::min(2 * pause, longest_pause);
        links_->say_what_is_missing(waited);
    }
}

const Plan& Cluster::plan() const { return links_->plan; }

void Cluster::call(const std::string& endpoint) { links_->call(endpoint); }

void Cluster::lost(const std::string& name) {
    if (auto* link = links_->find(name); link && link->state() != State::calling)
        link->lose(Clock::now(), "its process has ended");
    links_->tell_changes();
}

bool Cluster::ready(const std::string& name) const {
    const auto* link = links_->find(name);
    return link && link->state() == State::ready;
}

std::vector<HostState> Cluster::hosts() const { return links_->hosts(); }

std::map<std::string, std::string> Cluster::missing() const {
    std::map<std::string, std::string> missing;
    const auto& s = *links_;
    for (const auto& name : s.options.expected)
        if (!s.find(name)) missing[name] = "has not joined";
    for (const auto& link : s.links)
        if (!link->takes_part()) missing[link->name()] = trouble_of(*link);
    return missing;
}

std::string Cluster::join_endpoint() const { return links_->joiners ? links_->joiners->endpoint() : std::string(); }

Counters Cluster::finish(std::chrono::milliseconds patience) {
    std::set<HostLink*> open;
    for (auto& link : links_->links)
        if (link->state() != State::calling && link->state() != State::refused) {
            link->send_end();
            open.insert(link.get());
        }
    const auto end = Clock::now() + patience;
    const HostLink::Takers nobody{[](Message) {}, [](HostLink&, Frames&) {}};
    while (!open.empty() && Clock::now() < end) {
        links_->take_joiners(Clock::now());
        for (auto* link : std::set(open)) {
            while (link->receive(Clock::now(), nobody)) {
            }
            if (const auto counted = link->take_ended()) {
                links_->ended += *counted;
                open.erase(link);
            }
        }
        if (!open.empty()) links_->wait(std::chrono::milliseconds(5));  // no more: who ended would be called again
    }
    Counters sum = links_->counters;
    sum += links_->ended;
    if (links_->own) sum += links_->own->stop();
    links_->own.reset();
    return sum;
}

bool Cluster::ask(const PlaceAt& to, Message& message) {
    if (to.host.empty()) return links_->own && links_->own->ask(message, to.index);
    auto* link = links_->find(to.host);
    // A host that leaves gets no more work; but who waits there for a lock is to get it.
    const bool step = std::holds_alternative<Questions<Step>>(message.questions);
    return link && (link->state() == State::ready || (step && link->takes_part())) && link->send(message, to.index);
}

void Cluster::reply(Message) {}  // nobody asks the launcher

std::optional<Message> Cluster::receive() {
    links_->look();
    if (links_->arrived.empty()) return std::nullopt;
    Message message = std::move(links_->arrived.front());
    links_->arrived.pop_front();
    return message;
}

void Cluster::wait(std::chrono::nanoseconds most) {
    links_->look();
    if (links_->arrived.empty()) links_->wait(most);
}

bool Cluster::take_out(const std::string& host, const std::string& why) {
    const bool out = links_->take_out(host, why);
    links_->tell_changes();
    return out;
}

bool Cluster::bring(const PlaceAt& to, const Hash& name, const Bytes& bytes) {
    if (to.host.empty() || packet::goes_along(bytes)) return true;  // the former by pointer
    auto* link = links_->find(to.host);
    return link && link->state() == State::ready && link->bring(name, bytes);
}

void Cluster::adopt(const Plan& plan) {
    links_->in_force = to_json(plan);
    for (auto& link : links_->links)
        if (link->takes_part()) link->send_plan(links_->in_force);
    if (links_->own_ready) links_->own->use(plan);
}

const Counters& Cluster::counters() const { return links_->counters; }

}  // namespace lightnet
