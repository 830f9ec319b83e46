#include "core/run/place/place.hpp"

#include <algorithm>
#include <numeric>
#include <set>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/unwanted.hpp"
#include "core/network/graph/layout.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {
namespace {

std::uint64_t nanoseconds_since(std::chrono::steady_clock::time_point begun) {
    return static_cast<std::uint64_t>(std::chrono::nanoseconds(std::chrono::steady_clock::now() - begun).count());
}

}  // namespace

Place::Place(const Network& network, const PlaceAt& me, const Plan& plan, std::uint64_t run, const Tuning& tuning,
             Carrier& carrier, Gauge& gauge)
    : network_(network),
      me_(me),
      plan_(plan),
      run_(run),
      tuning_(tuning),
      carrier_(carrier),
      gauge_(gauge),
      rays_before_(Scene::rays_of_this_thread()),
      rounds_(fibers_, tuning.side_fibers, wake()),
      inboxes_(network.graph.nodes.size()),
      by_rank_(network.graph.nodes.size()),
      channels_(carrier, run, {me.host, name_of(me)}, counters_),
      locks_(fibers_, wake(), reply()),
      meter_(
          gauge, asking_edges(network.graph, network.layers, network.registry),
          [this] { return fibers_.current() ? fibers_.running_time(fibers_.current()) : std::chrono::nanoseconds{}; }),
      assembly_(
          network, [this](std::size_t node, std::size_t width) { return port_to(node, width); },
          {.locks = &locks_, .concurrent = &rounds_, .whereabouts = [this] { return whereabouts(); }}, meter_.tap()),
      preparer_(network, assembly_, fibers_, {my_name(), wake(), reply(), [this] { look(); }}) {
    assembly_.show(gauge);
    meter_.tell_learning([this](std::size_t node) {
        if (learning_.empty()) return false;
        const auto found = learning_.find(fibers_.current());
        return found != learning_.end() && found->second == node;
    });
    fibers_.show(gauge.shown(), Gauge::asking);
    const auto rank = ranks_of(network.graph);
    std::iota(by_rank_.begin(), by_rank_.end(), 0);
    std::stable_sort(by_rank_.begin(), by_rank_.end(), [&](auto a, auto b) { return rank[a] < rank[b]; });
    for (std::size_t node = 0; node < plan_.places_of.size(); ++node)
        if (holds(node)) assemble(node);
}

std::function<void(Fibers::Fiber*)> Place::wake() {
    return [this](Fibers::Fiber* fiber) { ready_.push_back(fiber); };
}

std::function<void(Message)> Place::reply() {
    return [this](Message reply) { carrier_.reply(std::move(reply)); };
}

bool Place::holds(std::size_t node) const {
    const auto& holders = plan_.places_of[node];
    return std::any_of(holders.begin(), holders.end(), [&](auto i) { return plan_.places[i] == me_; });
}

void Place::assemble(std::size_t node) {
    if (network_.kind_of(node).role == Role::light) assembly_.light(node);
    if (network_.kind_of(node).role == Role::image) assembly_.renderer(node);
}

Place::~Place() { fibers_.cancel_all(); }

std::string Place::my_name() const {
    return me_.host.empty() ? "place " + std::to_string(me_.index) : me_.host + " place " + std::to_string(me_.index);
}

Whereabouts Place::whereabouts() const {
    std::set<std::string> hosts;
    for (const auto& place : plan_.places) hosts.insert(place.host);
    return {.place = my_name(), .places = plan_.places.size(), .hosts = hosts.size()};
}

Port* Place::port_to(std::size_t node, std::size_t width) {
    return sectors_of(network_.graph, node).empty() ? port_to_one(node, width) : port_to_sectors(node, width);
}

Port* Place::port_to_sectors(std::size_t node, std::size_t width) {
    std::vector<Port*> ports;
    for (const auto sector : sectors_of(network_.graph, node)) ports.push_back(port_to_one(sector, width));
    const auto sector_of = [this, node, cut = std::shared_ptr<const Sectors>()](const Query& question) mutable {
        if (!cut) cut = network_.sectors(node);  // when it is first needed, as it takes a moment
        return cut->at(network_.scene->surface(question).position);
    };
    return sector_ports_.emplace_back(std::make_unique<SectorPort>(std::move(ports), width, sector_of)).get();
}

Port* Place::port_to_one(std::size_t node, std::size_t width) {
    auto& port = ports_[{node, width}];
    if (!port) {
        port = std::make_unique<RoutingPort>([=, this] { return direct_port_to(node, width); },
                                             [=, this] { return bundle_port_to(node, width); });
        use(node, width, *port);
    }
    return port.get();
}

Port* Place::direct_port_to(std::size_t node, std::size_t width) {
    direct_ports_.push_back(
        std::make_unique<DirectPort>(assembly_.callee(node), width, counters_.local_questions, [this] { pause(); }));
    return direct_ports_.back().get();
}

Port* Place::bundle_port_to(std::size_t node, std::size_t width) {
    auto& remote = remotes_[{node, width}];
    const Credit credit{tuning_.credit, tuning_.credit_questions, tuning_.credit_bytes};
    const BundleRules bundles{tuning_.bundle, std::chrono::microseconds(tuning_.oldest_us), tuning_.eager};
    remote.edge = {static_cast<std::uint32_t>(node), credit, {}, {}};
    if (tuning_.call_own_nodes) remote.edge.reserve = me_;
    remote.port = std::make_unique<BundlePort>(fibers_, wake(), width, bundles, &gauge_.nodes[node], &gauge_);
    remote.port->replicas().follow(multiplexer_rules(node), &counters_);
    remote.port->keep_back(called_here(node) && !helpers(node).empty());
    channels_.connect(remote.edge, remote.port->replicas(), plan_for(node));
    return remote.port.get();
}

// Itself, or somebody whom it asks: what is still under way when a rehearsal is over would be noted in the next.
bool Place::may_rehearse(std::size_t node) const {
    const auto needed = used_nodes(network_.graph, node);
    for (std::size_t other = 0; other < needed.size(); ++other)
        if (needed[other] && network_.kind_of(other).run.rehearses) return true;
    return false;
}

MultiplexerRules Place::multiplexer_rules(std::size_t node) {
    MultiplexerRules rules;
    rules.scheduling.strategy = plan_.strategy_of(node);
    rules.scheduling.double_tail = !may_rehearse(node);
    rules.scheduling.tail_part = 0.01;  // others want answers, too
    rules.at_fault = [this](const Failure& failure) { carrier_.take_out(failure.host, failure.why); };
    rules.checks = SpotChecks(tuning_.verify, secret_number());
    rules.own = me_.host;
    rules.doubt = [this, node](Failure lie) {
        if (!answers_alone(plan_, network_.graph, node)) lie.host.clear();
        carrier_.doubt(lie);
    };
    if (tuning_.check_answers) rules.differs = [](const std::string& what) { throw Error(what); };
    return rules;
}

void Place::use(const Plan& plan) {
    const auto before = std::exchange(plan_, plan);
    relieved_.clear();
    for (auto& [key, remote] : remotes_) remote.port->keep_back(false);
    for (auto& [key, port] : ports_) use(key.first, key.second, *port);
    for (auto& [key, remote] : remotes_) channels_.connect(remote.edge, remote.port->replicas(), plan_for(key.first));
    cancel_asks_of_lost(before);
}

// Nobody waits any more for answers to a place that is gone.
void Place::cancel_asks_of_lost(const Plan& before) {
    const auto lost = lost_names(before, plan_);
    if (lost.empty()) return;
    for (auto& inbox : inboxes_) {
        counters_.cancelled += std::erase_if(inbox.waiting, [&](const Message& ask) {
            if (!lost.contains(ask.asker)) return false;
            in_hand_.let_go(AsksInHand::name_of(ask));
            return true;
        });
        inbox.questions = inbox.answering;
        for (const auto& ask : inbox.waiting) inbox.questions += work_in(ask);
    }
}

void Place::serve(const std::atomic<bool>& stop, std::atomic<std::uint64_t>& progress) {
    stop_ = &stop;
    progress_ = &progress;
    const LookingAt looking(&stop);
    const TellingOfLostRays telling(assembly_.keeper_of_lost_rays());
    const auto begun = Clock::now();
    gauge_.set_activity(Gauge::asking);
    try {
        while (!stopping_ && !stop.load(std::memory_order_relaxed)) work_once(begun);
    } catch (const Cancelled&) {  // outside of fibers: while a plan is taken
    }
    stopping_ = true;
    record_.lived_ns = nanoseconds_since(begun);
    fibers_.cancel_all();
    gauge_.set_activity(Gauge::idle);
}

// For those who watch: a place tells its counters when it has stopped, which may be hours from now.
void Place::tell_so_far(Clock::time_point begun) {
    gauge_.rays.set(Scene::rays_of_this_thread() - rays_before_);
    gauge_.lived_ns.set(nanoseconds_since(begun));
    gauge_.waited_ns.set(record_.waited_ns);
    gauge_.idle_ns.set(record_.idle_ns);
}

void Place::work_once(Clock::time_point begun) {
    take_in();
    tell_so_far(begun);
    flush(false);
    if (!step()) {
        if (!flush(true) && !stopping_) wait();
        return;
    }
    // Each look at the sockets costs system calls: what has come together is worked off together.
    while (!fibers_.stint_over() && step()) {
    }
}

void Place::wait() {
    const auto begun = Clock::now();
    const ScopedActivity turned(gauge_, fibers_.alive() > 0 ? Gauge::waiting : Gauge::idle);
    carrier_.wait(patience());
    (fibers_.alive() ? record_.waited_ns : record_.idle_ns) += nanoseconds_since(begun);
}

// Runs one thing: a fiber whose answers are there, else a bundle of the lowest rank, else one more piece of what nodes
// do concurrently, else what others have left of its own questions, else paused work, else a new tile.
bool Place::step() {
    const auto resume_first_of = [&](auto& queue) {
        if (queue.empty()) return false;
        auto* fiber = queue.front();
        queue.pop_front();
        fibers_.resume(fiber);
        return true;
    };
    const auto as = [this](TraceKind kind) {
        if (tracer_) tracer_->next_is(kind);
        return true;
    };
    return resume_first_of(ready_) || (as(TraceKind::prepare) && preparer_.start_next()) || start_next(false) ||
           (as(TraceKind::light) && (rounds_.start_one() || start_own())) || resume_first_of(paused_) ||
           start_next(true);
}

void Place::trace(PlaceTracer& tracer) {
    tracer_ = &tracer;
    fibers_.watch(&tracer);
    meter_.trace(&tracer);
}

bool Place::may_start(std::size_t node) const {
    const auto& inbox = inboxes_[node];
    return !inbox.waiting.empty() && (inbox.fibers == 0 || spare_in_use_ < tuning_.spare_fibers);
}

bool Place::start_next(bool images) {
    for (const auto node : by_rank_) {
        if (!may_start(node) || (network_.kind_of(node).role == Role::image) != images) continue;
        auto asks = std::make_shared<std::vector<Message>>(next_asks(node));
        if (tracer_)
            tracer_->next_is(images                                                             ? TraceKind::tiles
                             : std::holds_alternative<Questions<Step>>(asks->front().questions) ? TraceKind::prepare
                                                                                                : TraceKind::light);
        fibers_.start(network_.graph.nodes[node].name.c_str(), [this, asks] { answer(*asks); });
        return true;
    }
    return false;
}

void Place::take_in() {
    while (auto message = carrier_.receive()) take(std::move(*message));
    last_look_ = Clock::now();
    if (tracer_) {
        std::size_t waiting = 0;
        for (const auto& inbox : inboxes_) waiting += inbox.questions - inbox.answering;
        tracer_->waiting(waiting);
    }
    fibers_.begin_stint(std::chrono::microseconds(50));
}

void Place::take(Message message) {
    switch (message.type) {
        case Message::Type::ask: {
            if (message.run != run_ || message.node >= inboxes_.size()) return;
            const auto* steps = std::get_if<Questions<Step>>(&message.questions);
            if (!steps || (*steps)->front().kind == Step::Kind::shards) return queue(std::move(message));
            if ((*steps)->front().kind >= Step::Kind::attend) return locks_.take(std::move(message));
            if (network_.kind_of(message.node).run.prepares) preparer_.take(std::move(message));
            return;
        }
        case Message::Type::reply:
        case Message::Type::failure:
            if (message.run == run_) channels_.arrived(message);
            return;
        case Message::Type::plan:
            if (message.run == run_ && message.plan) use(*message.plan);
            return;
        case Message::Type::stop:
            if (message.run == run_) stopping_ = true;
            return;
    }
}

void Place::queue(Message message) {
    if (!in_hand_.take(message)) return;
    auto& inbox = inboxes_[message.node];
    inbox.questions += work_in(message);
    gauge_.nodes[message.node].waiting.set(inbox.questions);
    inbox.waiting.push_back(std::move(message));
}

// Other threads may call it for us.
void Place::look() const {
    gauge_.pulse.add(1);
    if (stop_ && stop_->load(std::memory_order_relaxed)) throw Cancelled{};
}

// Is there anything to go on with, or to begin of nodes of this role?
bool Place::has_more(Role role) const {
    return !ready_.empty() || std::any_of(by_rank_.begin(), by_rank_.end(), [&](auto node) {
        return may_start(node) && network_.kind_of(node).role == role;
    });
}

// Called by running work at every ask of a node of this place: a busy place still serves others.
void Place::pause() {
    auto* fiber = fibers_.current();
    if (!fiber) return;
    const auto now = Clock::now();
    if (now - last_look_ < std::chrono::microseconds(200)) return;
    gauge_.pulse.add(1);
    take_in();
    look();
    if (stopping_) throw Cancelled{};
    flush(false);
    if (!has_more(Role::light)) return;
    paused_.push_back(fiber);
    fibers_.park();
}

bool Place::flush(bool idle) {
    const auto now = Clock::now();
    if (!relieved_.empty()) share_out();
    bool sent = false;
    for (auto& [key, remote] : remotes_) sent |= remote.port->flush(now, idle);
    return sent;
}

std::chrono::nanoseconds Place::patience() const {
    std::chrono::nanoseconds least = std::chrono::milliseconds(100);
    const auto now = Clock::now();
    for (const auto& [key, remote] : remotes_) least = std::min(least, remote.port->until_due(now));
    return least;
}

Counters Place::counters() const {
    Counters counters = counters_;
    counters += carrier_.counters();
    counters.not_finite = assembly_.not_finite();
    counters.off_surface = assembly_.off_surface();
    counters.unsound_questions = assembly_.unsound_questions();
    counters.lost_rays = assembly_.lost_rays();
    counters.prepared_bytes = preparer_.result_bytes();
    counters.rays = Scene::rays_of_this_thread() - rays_before_;
    counters.places.push_back(record());
    return counters;
}

PlaceRecord Place::record() const {
    PlaceRecord record = record_;
    record.host = me_.host, record.index = me_.index;
    meter_.write(network_.graph, record);
    const auto& nodes = network_.graph.nodes;
    for (std::size_t node = 0; node < inboxes_.size(); ++node)
        if (inboxes_[node].figures.answered) record.nodes[nodes[node].name] = inboxes_[node].figures;
    for (const auto& [node, spent] : preparer_.spent()) {
        auto& to = record.nodes[nodes[node].name];
        to.shards = spent.shards, to.prepare_ns = spent.ns, to.prepared = spent.bytes;
    }
    for (std::size_t node = 0; node < gauge_.nodes.size(); ++node) {
        const auto& sent = gauge_.nodes[node];
        if (!sent.bundles.get()) continue;
        auto& to = record.nodes[nodes[node].name];
        to.bundles = sent.bundles.get(), to.replies = sent.answered.get(), to.latency_ns = sent.nanoseconds.get();
    }
    return record;
}

}  // namespace lightnet
