#include "core/run/runtime/place.hpp"

#include <algorithm>
#include <numeric>
#include <set>
#include <utility>

#include "core/base/error.hpp"
#include "core/network/graph/layout.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {
Place::Place(const Network& network, const PlaceAt& me, const Plan& plan, std::uint64_t run, const Tuning& tuning,
             Carrier& carrier)
    : network_(network),
      me_(me),
      plan_(plan),
      run_(run),
      tuning_(tuning),
      carrier_(carrier),
      rays_before_(Scene::rays_of_this_thread()),
      rounds_(fibers_, tuning.side_fibers, wake()),
      inboxes_(network.graph.nodes.size()),
      by_rank_(network.graph.nodes.size()),
      channels_(carrier, run, name_of(me), counters_),
      locks_(fibers_, wake(), reply()),
      assembly_(
          network, [this](std::size_t node, std::size_t width) { return port_to(node, width); }, locks_, &rounds_),
      preparer_(network, assembly_, fibers_,
                {my_name(), wake(), reply(), [this](std::size_t node) { return plan_.places_of[node].size(); }}) {
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
        port = std::make_unique<PlannedPort>([=, this] { return direct_port_to(node, width); },
                                             [=, this] { return bundle_port_to(node, width); });
        port->use(called_here(node));
    }
    return port.get();
}

bool Place::called_here(std::size_t node) const { return tuning_.call_own_nodes && holds(node); }

Port* Place::direct_port_to(std::size_t node, std::size_t width) {
    direct_ports_.push_back(
        std::make_unique<DirectPort>(assembly_.callee(node), width, counters_.local_questions, [this] { pause(); }));
    return direct_ports_.back().get();
}

Port* Place::bundle_port_to(std::size_t node, std::size_t width) {
    auto& remote = remotes_[{node, width}];
    const Credit credit{tuning_.credit, tuning_.credit_questions, tuning_.credit_bytes};
    const BundleRules bundles{tuning_.bundle, std::chrono::microseconds(tuning_.oldest_us), tuning_.eager};
    remote.edge = {static_cast<std::uint32_t>(node), credit, {}};
    remote.port = std::make_unique<BundlePort>(fibers_, wake(), width, bundles);
    remote.port->replicas().follow(multiplexer_rules(node), &counters_);
    channels_.connect(remote.edge, remote.port->replicas(), plan_);
    return remote.port.get();
}

MultiplexerRules Place::multiplexer_rules(std::size_t node) {
    MultiplexerRules rules;
    rules.scheduling.strategy = plan_.strategy_of(node);
    rules.scheduling.usual = tuning_.bundle;
    rules.at_fault = [this](const Failure& failure) { carrier_.take_out(failure.host, failure.why); };
    if (tuning_.check_answers) rules.differs = [](const std::string& what) { throw Error(what); };
    return rules;
}

void Place::use(const Plan& plan) {
    const auto before = std::exchange(plan_, plan);
    for (auto& [key, port] : ports_) port->use(called_here(key.first));
    for (auto& [key, remote] : remotes_) channels_.connect(remote.edge, remote.port->replicas(), plan_);
    cancel_asks_of_lost(before);
}

// Nobody waits any more for answers to a place that is gone. One that this place has not heard of yet is not gone.
void Place::cancel_asks_of_lost(const Plan& before) {
    std::set<std::uint64_t> lost;
    for (const auto& place : before.places) lost.insert(name_of(place));
    for (const auto& place : plan_.places) lost.erase(name_of(place));
    if (lost.empty()) return;
    for (auto& inbox : inboxes_) {
        counters_.cancelled +=
            std::erase_if(inbox.waiting, [&](const Message& ask) { return lost.contains(ask.asker); });
        inbox.questions = inbox.answering;
        for (const auto& ask : inbox.waiting) inbox.questions += work_in(ask);
    }
}

void Place::serve(const std::atomic<bool>& stop, std::atomic<std::uint64_t>& progress) {
    stop_ = &stop;
    progress_ = &progress;
    while (!stopping_ && !stop.load(std::memory_order_relaxed)) {
        take_in();
        flush(false);
        if (!step()) {
            if (!flush(true) && !stopping_) carrier_.wait(patience());
            continue;
        }
        // Each look at the sockets costs system calls: what has come together is worked off together.
        while (!fibers_.stint_over() && step()) {
        }
    }
    stopping_ = true;
    fibers_.cancel_all();
}

// Runs one thing: a fiber whose answers are there, else a bundle of the lowest rank, else one more piece of what nodes
// do concurrently, else paused work, else a new tile.
bool Place::step() {
    const auto resume_first_of = [&](auto& queue) {
        if (queue.empty()) return false;
        auto* fiber = queue.front();
        queue.pop_front();
        fibers_.resume(fiber);
        return true;
    };
    return resume_first_of(ready_) || preparer_.start_next() || start_next(false) || rounds_.start_one() ||
           resume_first_of(paused_) || start_next(true);
}

bool Place::may_start(std::size_t node) const {
    const auto& inbox = inboxes_[node];
    return !inbox.waiting.empty() && (inbox.fibers == 0 || spare_in_use_ < tuning_.spare_fibers);
}

bool Place::start_next(bool images) {
    for (const auto node : by_rank_) {
        if (!may_start(node) || (network_.kind_of(node).role == Role::image) != images) continue;
        auto asks = std::make_shared<std::vector<Message>>(next_asks(node));
        fibers_.start(network_.graph.nodes[node].name.c_str(), [this, asks] { answer(*asks); });
        return true;
    }
    return false;
}

void Place::take_in() {
    while (auto message = carrier_.receive()) take(std::move(*message));
    last_look_ = Clock::now();
    fibers_.begin_stint(std::chrono::microseconds(50));
}

void Place::take(Message message) {
    switch (message.type) {
        case Message::Type::ask: {
            if (message.run != run_ || message.node >= inboxes_.size()) return;
            const auto* steps = std::get_if<Questions<Step>>(&message.questions);
            if (!steps || (*steps)->front().kind == Step::Kind::shards) return queue(std::move(message));
            if ((*steps)->front().kind >= Step::Kind::attend) return locks_.take(std::move(message));
            if (network_.kind_of(message.node).prepares) preparer_.take(std::move(message));
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
    auto& inbox = inboxes_[message.node];
    inbox.questions += work_in(message);
    inbox.waiting.push_back(std::move(message));
}

// Called by running work at every ask of a node of this place: a busy place still serves others.
void Place::pause() {
    auto* fiber = fibers_.current();
    if (!fiber) return;
    const auto now = Clock::now();
    if (now - last_look_ < std::chrono::microseconds(200)) return;
    take_in();
    if (stopping_ || (stop_ && stop_->load(std::memory_order_relaxed))) throw Cancelled{};
    flush(false);
    const bool others = !ready_.empty() || std::any_of(by_rank_.begin(), by_rank_.end(), [&](auto node) {
        return may_start(node) && network_.kind_of(node).role == Role::light;
    });
    if (!others) return;
    paused_.push_back(fiber);
    fibers_.park();
}

bool Place::flush(bool idle) {
    const auto now = Clock::now();
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
    counters.prepared_bytes = preparer_.result_bytes();
    counters.rays = Scene::rays_of_this_thread() - rays_before_;
    return counters;
}

}  // namespace lightnet
