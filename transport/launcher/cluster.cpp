#include "transport/launcher/cluster.hpp"

#include <set>

#include "transport/launcher/cluster_links.hpp"

namespace lightnet {
namespace {

using Clock = std::chrono::steady_clock;
using State = HostLink::State;

}  // namespace

Cluster::Cluster(Options options) : links_(std::make_unique<Links>(std::move(options))) {}
Cluster::~Cluster() = default;

void Cluster::gather(HostPatience patience, const std::atomic<bool>& cancelled,
                     const std::function<void()>& look_around) {
    constexpr auto at_once = std::chrono::milliseconds(1), now_and_then = std::chrono::milliseconds(20);
    constexpr auto soon = std::chrono::milliseconds(250);  // so long, hosts that are there answer quickly
    const auto begun = Clock::now();
    links_->expected.begin(patience, begun);
    HostWait host_wait(patience, begun);
    while (!cancelled) {
        wait(Clock::now() - begun < soon ? at_once : now_and_then);
        look_around();
        links_->arrived.clear();  // plans on the way here; plan() is the one that counts
        const auto all = links_->standing();
        throw_if_broken(links_->links, !all.ready && !all.pending && !all.busy && !all.absent);
        const auto now = Clock::now();
        const auto verdict = host_wait.look(all, now);
        if (verdict == HostWait::Verdict::begin) return;
        if (verdict == HostWait::Verdict::nobody && links_->all_unknown())
            throw NobodyKnown("no worker that we know, and that knows us:" + links_->reasons());
        if (verdict == HostWait::Verdict::nobody) throw NoWorker("no worker can be reached:" + links_->reasons());
        if (verdict == HostWait::Verdict::nobody_free)
            throw NoWorker("no worker was free in time:" + links_->reasons());
        if (host_wait.should_speak(now)) links_->say_what_is_missing(now - begun);
    }
}

const Plan& Cluster::plan() const { return links_->plan; }

void Cluster::call(const std::string& endpoint, const HostKey& key) { links_->call(endpoint, key); }

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

bool Cluster::drain(const std::string& name) {
    auto* link = links_->find(name);
    return link && links_->others_are_ready(name) && link->drain();
}

void Cluster::watch() { links_->watched = true; }

Doings Cluster::doing() const {
    Doings all;
    for (const auto& link : links_->links)
        if (link->takes_part()) all.merge(link->doing());
    return all;
}

const std::optional<Failure>& Cluster::lie() const { return links_->lie; }

void Cluster::doubt(const Failure& lie) { links_->doubt(lie, ""); }

std::uint64_t Cluster::renewed_lines() const {
    std::uint64_t all = 0;
    for (const auto& link : links_->links) all += link->renewed_lines();
    return all;
}

std::map<std::string, std::string> Cluster::missing() const {
    std::map<std::string, std::string> missing;
    const auto& s = *links_;
    for (const auto& name : s.options.expected)
        if (!s.find(name)) missing[name] = "has not joined";
    for (const auto& link : s.links)
        if (!link->takes_part()) missing[link->title()] = link->trouble();
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
    const HostLink::Handlers nobody{[](Message) {}, [](HostLink&, Frames&) {}};
    while (!open.empty() && Clock::now() < end) {
        links_->take_joiners(Clock::now());
        for (auto* link : std::set(open)) {
            while (link->receive(Clock::now(), nobody)) {
            }
            for (const auto& failure : link->take_failures())
                if (failure.lie) links_->doubt(failure, link->name());
            if (const auto counted = link->take_ended()) {
                links_->ended += *counted;
                open.erase(link);
            }
        }
        if (!open.empty()) links_->wait(std::chrono::milliseconds(5));  // no more: who ended would be called again
    }
    Counters sum = links_->counters;
    sum += links_->ended;
    for (auto* link : open) sum += link->wait_for_end();
    return sum;
}

bool Cluster::ask(const PlaceAt& to, Message& message) {
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

std::uint64_t Cluster::pulse(const std::string& host) const {
    const auto* link = links_->find(host);
    return link ? link->pulse() : 0;
}

bool Cluster::take_out(const std::string& host, const std::string& why) {
    const bool out = links_->take_out(host, why);
    links_->tell_changes();
    return out;
}

bool Cluster::expects_hosts() const { return links_->expected.may_come(links_->standing(), Clock::now()); }

bool Cluster::bring(const PlaceAt& to, const Hash& name, const Bytes& bytes) {
    if (packet::goes_along(bytes)) return true;
    auto* link = links_->find(to.host);
    return link && link->state() == State::ready && link->bring(name, bytes);
}

void Cluster::adopt(const Plan& plan) {
    links_->in_force = WrittenPlan{plan, to_json(plan)};
    for (auto& link : links_->links)
        if (link->takes_part()) link->use(*links_->in_force);
}

const Counters& Cluster::counters() const { return links_->counters; }

}  // namespace lightnet
