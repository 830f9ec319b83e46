#include "transport/cluster.hpp"

#include <algorithm>
#include <deque>
#include <set>
#include <zmq.hpp>

#include "core/error.hpp"
#include "core/runtime/fingerprint.hpp"
#include "transport/host_link.hpp"
#include "transport/sockets.hpp"

namespace lightnet {
namespace {

using Clock = std::chrono::steady_clock;
using State = HostLink::State;

// Where a host that listens on all its addresses can be called: at the one from which it dialled in.
std::string callable(const std::string& endpoint, zmq::message_t& from) {
    const std::string all = "tcp://0.0.0.0:";
    if (!endpoint.starts_with(all)) return endpoint;
    const char* address = from.gets("Peer-Address");
    return address ? "tcp://" + std::string(address) + ":" + endpoint.substr(all.size()) : endpoint;
}

constexpr std::size_t most_hosts = 4096;

Told told_of(const Cluster::Options& options) {
    Told told{options.run, options.job.isa, fingerprint(options.job.isa), to_json(options.job), {}};
    for (const auto& file : options.job.files) told.blobs[file.hash] = options.files.at(file.path);
    return told;
}

}  // namespace

struct Cluster::Links {
    Options options;
    Told told;
    zmq::context_t context{1};
    std::optional<zmq::socket_t> joining;  // where hosts dial in
    std::vector<std::unique_ptr<HostLink>> links;
    std::map<std::string, State> states;  // as last told
    Plan plan;                            // proposed
    std::string in_force;                 // the plan that hosts are to go by, as text
    std::deque<Message> arrived;
    Counters counters;

    explicit Links(Options given) : options(std::move(given)), told(told_of(options)) {
        plan.places_of.resize(options.job.graph.nodes.size());
        if (!options.listen.empty()) {
            joining.emplace(answering_socket(context));
            joining->bind(options.listen);
        }
        for (const auto& endpoint : options.endpoints) add(endpoint);
    }

    HostLink* find(const std::string& endpoint) {
        for (auto& link : links)
            if (link->endpoint() == endpoint) return link.get();
        return nullptr;
    }
    void add(const std::string& endpoint) {
        if (!find(endpoint)) links.push_back(std::make_unique<HostLink>(context, told, counters, endpoint));
    }

    // Offers of all hosts that are at least so far, in the order in which they were named.
    std::vector<HostOffer> offers(bool ready_only) const {
        std::vector<HostOffer> offers;
        for (const auto& link : links) {
            const auto state = link->state();
            const bool greeted = state == State::greeted || state == State::sending || state == State::building;
            if (state == State::ready || (!ready_only && greeted)) offers.push_back({link->endpoint(), link->places()});
        }
        return offers;
    }

    void look() {
        const auto now = Clock::now();
        take_joiners();
        const auto expected_plan = [&] { return to_json(options.plan(offers(false))); };
        for (auto& link : links) {
            // What has come counts before the lease is looked at: we may have been busy ourselves.
            for (auto [any, message] = link->receive(now); any; std::tie(any, message) = link->receive(now))
                if (message) arrived.push_back(std::move(*message));
            link->tick(now, expected_plan);
        }
        tell_changes();
    }

    void take_joiners() {
        if (!joining) return;
        while (auto frames = receive_frames(*joining)) {
            if (frames->size() != 3) continue;
            const auto header = packet::read_header(bytes_of((*frames)[1]), bytes_of((*frames)[2]));
            const auto fields = header ? packet::unpack_fields(bytes_of((*frames)[2])) : std::nullopt;
            if (!fields || header->type != packet::Type::join) continue;
            try {
                if (links.size() < most_hosts) add(callable(fields->text("endpoint"), frames->back()));
            } catch (const zmq::error_t&) {  // not an endpoint at all
                ++counters.broken_packets;
                continue;
            }
            frames->resize(1);
            append(*frames, packet::pack(packet::Type::joined, told.run, {}));
            send_frames(*joining, *frames);
        }
    }

    // Hosts that became ready or are no more: a new plan is proposed, and a line said for the user.
    void tell_changes() {
        bool changed = false;
        for (auto& link : links) {
            const auto before = states.contains(link->endpoint()) ? states[link->endpoint()] : State::calling;
            const auto state = states[link->endpoint()] = link->state();
            if (state == before) continue;
            if (state == State::ready) options.say(link->endpoint() + " is ready");
            if (state == State::ready && !in_force.empty()) link->send_plan(in_force);
            if (state == State::refused) options.say(link->endpoint() + " takes no part: " + link->reason());
            if (before == State::ready && state != State::refused)
                options.say(link->endpoint() + " is lost: " + link->reason() + "; its work is asked again elsewhere");
            changed |= state == State::ready || before == State::ready;
        }
        if (!changed) return;
        const auto there = offers(true);
        plan = there.empty() ? Plan{{}, std::vector<std::vector<std::uint32_t>>(options.job.graph.nodes.size())}
                             : options.plan(there);
        Message message;
        message.type = Message::Type::plan;
        message.run = options.run;
        message.plan = std::make_shared<const Plan>(plan);
        arrived.push_back(std::move(message));
    }

    std::string reasons() const {
        std::string text;
        for (const auto& link : links)
            text += "\n  " + link->endpoint() + ": " + (link->reason().empty() ? "does not answer" : link->reason());
        return text;
    }
};

Cluster::Cluster(Options options) : links_(std::make_unique<Links>(std::move(options))) {}
Cluster::~Cluster() = default;

void Cluster::gather(std::chrono::milliseconds patience, const std::atomic<bool>& cancelled) {
    const auto begun = Clock::now();
    std::string said;
    while (!cancelled) {
        wait(std::chrono::milliseconds(20));
        bool ready = false, pending = false, absent = false, busy = false;
        for (const auto& link : links_->links) {
            if (link->broken()) throw Error(link->endpoint(), link->reason());
            ready |= link->state() == State::ready;
            absent |= link->state() == State::calling;
            const bool greeted = link->state() == State::greeted;
            busy |= greeted && !link->reason().empty();
            pending |= (greeted && link->reason().empty()) || link->state() == State::sending ||
                       link->state() == State::building;
        }
        if (busy && said.empty())
            links_->options.say(said = "waiting for hosts that serve another run" + links_->reasons());
        const bool patient = Clock::now() - begun < patience;
        if (pending || (patient && (absent || busy || links_->links.empty()))) continue;
        if (ready) {
            links_->arrived.clear();  // plans on the way here; plan() is the one that counts
            return;
        }
        if (!busy) throw NoWorker("no worker can be reached:" + links_->reasons());
    }
}

const Plan& Cluster::plan() const { return links_->plan; }

void Cluster::call(const std::string& endpoint) { links_->add(endpoint); }

void Cluster::lost(const std::string& endpoint) {
    if (auto* link = links_->find(endpoint); link && link->state() != State::calling)
        link->lose(Clock::now(), "its process has ended");
    links_->tell_changes();
}

std::string Cluster::join_endpoint() const {
    return links_->joining ? links_->joining->get(zmq::sockopt::last_endpoint) : std::string();
}

Counters Cluster::finish(std::chrono::milliseconds patience) {
    std::set<HostLink*> open;
    for (auto& link : links_->links)
        if (link->state() != State::calling && link->state() != State::refused) {
            link->send_end();
            open.insert(link.get());
        }
    const auto end = Clock::now() + patience;
    Counters sum = links_->counters;
    while (!open.empty() && Clock::now() < end) {
        for (auto* link : std::set(open)) {
            while (link->receive(Clock::now()).first) {
            }
            if (link->ended()) {
                sum += *link->ended();
                open.erase(link);
            }
        }
        if (!open.empty()) wait(std::chrono::milliseconds(5));
    }
    return sum;
}

bool Cluster::ask(const PlaceAt& to, Message& message) {
    auto* link = links_->find(to.host);
    return link && link->state() == State::ready && link->send(message, to.index);
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
    if (!links_->arrived.empty()) return;
    std::vector<zmq::pollitem_t> items;
    bool sending = false;
    for (auto& link : links_->links) {
        sending |= link->state() == State::sending;
        for (auto* socket : link->sockets()) items.push_back({socket->handle(), 0, ZMQ_POLLIN, 0});
    }
    if (links_->joining) items.push_back({links_->joining->handle(), 0, ZMQ_POLLIN, 0});
    const auto ms = std::clamp(std::chrono::ceil<std::chrono::milliseconds>(most), std::chrono::milliseconds(1),
                               std::chrono::milliseconds(sending ? 5 : 100));
    try {
        zmq::poll(items, ms);
    } catch (const zmq::error_t& error) {
        if (error.num() != EINTR) throw;
    }
}

bool Cluster::bring(const PlaceAt& to, const Hash& name, const Bytes& bytes) {
    auto* link = links_->find(to.host);
    return link && link->state() == State::ready && link->bring(name, bytes);
}

void Cluster::adopt(const Plan& plan) {
    links_->in_force = to_json(plan);
    for (auto& link : links_->links)
        if (link->state() == State::ready) link->send_plan(links_->in_force);
}

const Counters& Cluster::counters() const { return links_->counters; }

}  // namespace lightnet
