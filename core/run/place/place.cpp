#include "core/run/place/place.hpp"

#include <algorithm>
#include <chrono>
#include <set>
#include <utility>

#include "core/base/unwanted.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {
namespace {

std::uint64_t nanoseconds_since(std::chrono::steady_clock::time_point begun) {
    return static_cast<std::uint64_t>(std::chrono::nanoseconds(std::chrono::steady_clock::now() - begun).count());
}

Plan without_holders(Plan plan) {
    for (auto& holders : plan.places_of) holders.clear();
    return plan;
}

}  // namespace

Place::Place(const Network& network, const PlaceAt& me, const Plan& plan, std::uint64_t run, const Tuning& tuning,
             Carrier& carrier, Gauge& gauge, Asks asks)
    : network_(network),
      me_(me),
      plan_(asks == Asks::by_plan ? plan : without_holders(plan)),
      run_(run),
      tuning_(tuning),
      carrier_(carrier),
      gauge_(gauge),
      rays_before_(Scene::rays_of_this_thread()),
      rounds_(fibers_, tuning.side_fibers, wake()),
      inbox_({network, tuning_, gauge, counters_}),
      ports_({network, me_, run, tuning_, carrier, gauge, counters_, fibers_, wake(),
              [this]() -> Assembly& { return assembly_; }, [this] { pause(); },
              [this](std::size_t node, std::chrono::nanoseconds took) { inbox_.answered_here(node, took); },
              service_.own_time},
             plan_),
      locks_(fibers_, wake(), reply()),
      meter_(
          gauge, asking_edges(network.graph, network.layers, network.registry),
          [this] { return fibers_.current() ? fibers_.running_time(fibers_.current()) : std::chrono::nanoseconds{}; }),
      assembly_(network, [this](std::size_t node, std::size_t width) { return ports_.port_to(node, width); },
                {.locks = &locks_, .concurrent = &rounds_, .whereabouts = [this] { return whereabouts(); }},
                {.meter = &meter_}),
      preparer_(network, assembly_, fibers_,
                {my_name(), wake(), reply(), [this] { look(); },
                 [this](std::size_t node) { return inbox_.owes_answers(node); }}),
      answerer_({network, assembly_, preparer_, me_.host, my_name(), counters_.tiles}) {
    assembly_.show(gauge);
    meter_.tell_learning([this](std::size_t node) {
        if (learning_.empty()) return false;
        const auto found = learning_.find(fibers_.current());
        return found != learning_.end() && found->second == node;
    });
    fibers_.show(gauge.shown(), Gauge::asking);
    for (std::size_t node = 0; node < plan.places_of.size(); ++node)
        if (holds(plan, me_, node)) assemble(node);
}

std::function<void(Fibers::Fiber*)> Place::wake() {
    return [this](Fibers::Fiber* fiber) { ready_.push_back(fiber); };
}

std::function<void(Message)> Place::reply() {
    return [this](Message reply) { carrier_.reply(std::move(reply)); };
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

void Place::use(const Plan& plan) {
    const auto before = std::exchange(plan_, plan);
    ports_.use(plan);
    for (auto& ask : inbox_.later().due(plan.edition)) take(std::move(ask));
    inbox_.cancel(lost_names(before, plan));
}

void Place::begin(const std::atomic<bool>& stop, std::atomic<std::uint64_t>& progress) {
    service_ = {.stop = &stop, .progress = &progress, .begun = Clock::now()};
    gauge_.set_activity(Gauge::asking);
}

void Place::serve(const std::atomic<bool>& stop, std::atomic<std::uint64_t>& progress) {
    const LookingAt looking(&stop);
    const TellingOfLostRays telling(assembly_.keeper_of_lost_rays());
    begin(stop, progress);
    try {
        while (!service_.stopping && !stop.load(std::memory_order_relaxed)) work_once();
    } catch (const Cancelled&) {  // outside of fibers: while a plan is taken
    }
    service_.stopping = true;
    record_.lived_ns = nanoseconds_since(service_.begun);
    fibers_.cancel_all();
    gauge_.set_activity(Gauge::idle);
}

// For those who watch: a place tells its counters when it has stopped, which may be hours from now.
void Place::tell_so_far() {
    gauge_.rays.set(Scene::rays_of_this_thread() - rays_before_);
    gauge_.lived_ns.set(nanoseconds_since(service_.begun));
    gauge_.waited_ns.set(record_.waited_ns);
    gauge_.idle_ns.set(record_.idle_ns);
}

void Place::work_once() {
    take_in();
    tell_so_far();
    ports_.flush(false);
    if (!step()) {
        if (!ports_.flush(true) && !service_.stopping) wait();
        return;
    }
    // Each look at the sockets costs system calls: what has come together is worked off together.
    while (!fibers_.stint_over() && step()) {
    }
}

void Place::wait() {
    const auto begun = Clock::now();
    const ScopedActivity turned(gauge_, fibers_.alive() > 0 ? Gauge::waiting : Gauge::idle);
    ports_.wait();
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
           (as(TraceKind::light) && (rounds_.start_one() || ports_.start_own())) || resume_first_of(paused_) ||
           start_next(true);
}

void Place::trace(PlaceTracer& tracer) {
    tracer_ = &tracer;
    fibers_.watch(&tracer);
    meter_.trace(&tracer);
}

bool Place::start_next(bool images) {
    auto asks = std::make_shared<std::vector<Message>>(inbox_.next(images));
    if (asks->empty()) return false;
    if (tracer_)
        tracer_->next_is(images                                                             ? TraceKind::tiles
                         : std::holds_alternative<Questions<Step>>(asks->front().questions) ? TraceKind::prepare
                                                                                            : TraceKind::light);
    fibers_.start(network_.graph.nodes[asks->front().node].name.c_str(), [this, asks] { answer(*asks); });
    return true;
}

void Place::answer(std::vector<Message>& asks) {
    const auto work = inbox_.begin(asks);
    gauge_.set_activity(Gauge::at(work.node));
    const auto* fiber = fibers_.current();
    std::vector<Message> replies;
    for (auto& ask : asks) replies.push_back(reply_to(ask));
    if (work.learning) learning_[fiber] = work.node;
    answerer_.answer(asks, replies);
    learning_.erase(fiber);
    asks.clear();  // before the replies: an asker may use the memory of its questions again
    const Load load = inbox_.end(work, static_cast<std::uint64_t>(fibers_.running_time(fiber).count()));
    for (std::size_t i = 0; i < replies.size(); ++i) {
        auto& reply = replies[i];
        reply.load = load;
        reply.route = inbox_.let_go(work.names[i]);
        gauge_.pulse.add(1);
        service_.progress->fetch_add(1, std::memory_order_relaxed);  // before: the run may end with this reply
        carrier_.reply(std::move(reply));
    }
}

void Place::take_in() {
    while (auto message = carrier_.receive()) take(std::move(*message));
    last_look_ = Clock::now();
    if (tracer_) tracer_->waiting(inbox_.waiting());
    fibers_.begin_stint(std::chrono::microseconds(50));
}

void Place::take(Message message) {
    switch (message.type) {
        case Message::Type::ask: {
            if (message.run != run_ || !inbox_.knows(message.node)) return;
            if (inbox_.later().keep(message, plan_.edition)) return;
            const auto* steps = std::get_if<Questions<Step>>(&message.questions);
            // Whoever asks what has left has not heard of several plans: he asks others when nobody answers.
            if (!steps && preparer_.has_left(message.node)) return void(++counters_.cancelled);
            if (!steps || (*steps)->front().kind == Step::Kind::shards) return inbox_.take(std::move(message));
            if ((*steps)->front().kind >= Step::Kind::attend) return locks_.take(std::move(message));
            if (network_.kind_of(message.node).run.prepares) preparer_.take(std::move(message));
            return;
        }
        case Message::Type::reply:
        case Message::Type::failure:
            if (message.run == run_) ports_.arrived(message);
            return;
        case Message::Type::plan:
            if (message.run == run_ && message.plan) use(*message.plan);
            return;
        case Message::Type::stop:
            if (message.run == run_) service_.stopping = true;
            return;
    }
}

// Other threads may call it for us.
void Place::look() const {
    gauge_.pulse.add(1);
    if (service_.stop && service_.stop->load(std::memory_order_relaxed)) throw Cancelled{};
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
    if (service_.stopping) throw Cancelled{};
    ports_.flush(false);
    if (ready_.empty() && !inbox_.has_next(Role::light)) return;
    paused_.push_back(fiber);
    fibers_.park();
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
    for (std::size_t node = 0; node < nodes.size(); ++node)
        if (inbox_.figures(node).busy_ns) record.nodes[nodes[node].name] = inbox_.figures(node);
    for (const auto& [node, spent] : preparer_.spent()) {
        auto& to = record.nodes[nodes[node].name];
        to.shards = spent.shards, to.rounds = spent.rounds, to.prepare_ns = spent.ns, to.prepared = spent.bytes;
    }
    for (std::size_t node = 0; node < gauge_.nodes.size(); ++node) {
        const auto& sent = gauge_.nodes[node];
        if (!sent.bundles.get()) continue;
        auto& to = record.nodes[nodes[node].name];
        to.bundles = sent.bundles.get(), to.replies = sent.answered.get(), to.latency_ns = sent.nanoseconds.get();
    }
    // DECISIONS: costs-without-others
    const auto away = record.waited_ns + record.idle_ns;
    keep_of_work(
        service_.own_time.share_of(std::chrono::nanoseconds(record.lived_ns - std::min(away, record.lived_ns))),
        record);
    return record;
}

}  // namespace lightnet
