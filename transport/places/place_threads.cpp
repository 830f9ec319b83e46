#include "transport/places/place_threads.hpp"

#include <pthread.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <deque>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/words_of.hpp"
#include "core/run/assembly/place_tracer.hpp"
#include "core/run/assembly/sampling_profiler.hpp"
#include "core/run/message/place_name.hpp"
#include "core/run/place/dispatcher.hpp"
#include "transport/places/wakeup.hpp"

namespace lightnet {

struct PlaceThreads::Threads {
    enum class State { starting, serving, died, ended };
    // What a place tells this process, without a message: it must be able to tell that it has no descriptors left.
    struct Life {
        std::atomic<State> state{State::starting};
        std::atomic<std::uint64_t> progress{0};
        Counters counters;  // these two are written before `state` says that it has ended or died
        std::string died_of;
    };

    // Where a run is traced: one thread's, in the order in which they are needed.
    struct Tracing {
        Tracing(const Graph& graph, std::size_t most_events, Carrier& traced)
            : tracer(graph, most_events), carrier(traced, tracer) {}
        PlaceTracer tracer;
        TracingCarrier carrier;
    };

    PlaceTransport& transport;
    std::shared_ptr<const Network> network;
    std::uint64_t run;
    std::string host;
    Plan plan;
    Tuning rules;
    std::uint32_t count;         // of places
    std::vector<Life> lives;     // by place; behind them, the dispatcher's
    std::deque<Gauge> gauges{};  // by place
    std::unique_ptr<SamplingProfiler> profiler{};
    Wakeup news{};
    bool all_serve = false;
    std::atomic<bool> stop{false};
    std::mutex failures_mutex{};
    std::vector<Failure> failures{};
    std::vector<std::jthread> threads{};

    void serve(std::uint32_t index);
    std::unique_ptr<Tracing> trace(Carrier& carrier) const;
    void serve_place(std::uint32_t index, Life& life);
    void dispatch(Life& life);
    void change(Life& life, State state);
    void start();
    void tell(std::size_t end, Message::Type type, std::shared_ptr<const Plan> plan);
};

// From one niceness to the next the system's scheduler gives 1.25 times less. For the thread that calls it, for good.
void take_share(std::uint32_t percent) {
    const auto steps = static_cast<int>(std::lround(std::log(100.0 / percent) / std::log(1.25)));
    if (steps > 0) setpriority(PRIO_PROCESS, 0, getpriority(PRIO_PROCESS, 0) + steps);
}

void PlaceThreads::Threads::change(Life& life, State state) {
    life.state = state;
    news.notify();
}

void PlaceThreads::Threads::serve(std::uint32_t index) {
    auto& life = lives[index];
    const bool is_place = index < count;
    const std::string name = is_place ? "place " + std::to_string(index) : "dispatcher";
    pthread_setname_np(pthread_self(), name.c_str());  // for top, perf and debuggers
    take_share(rules.share);
    try {
        is_place ? serve_place(index, life) : dispatch(life);
        change(life, State::ended);
    } catch (const std::exception& error) {
        life.died_of = (is_place ? name : "the " + name) + ": " + words_of(error);
        change(life, State::died);
    }
}

std::unique_ptr<PlaceThreads::Threads::Tracing> PlaceThreads::Threads::trace(Carrier& carrier) const {
    if (!rules.trace) return nullptr;
    constexpr std::size_t of_process = 1 << 19, most = 1 << 15, least = 1 << 10;  // events; 32 bytes each
    return std::make_unique<Tracing>(network->graph, std::clamp(of_process / lives.size(), least, most), carrier);
}

void PlaceThreads::Threads::serve_place(std::uint32_t index, Life& life) {
    const auto at_fault = [this](const Failure& failure) {
        const std::lock_guard lock(failures_mutex);
        failures.push_back(failure);
        news.notify();
    };
    const auto carrier = transport.carrier_of(index, at_fault);
    auto tracing = trace(*carrier);
    const auto asks = lives.size() > count ? Place::Asks::when_told : Place::Asks::by_plan;
    Place place(*network, {host, index}, plan, run, rules, tracing ? tracing->carrier : *carrier, gauges[index], asks);
    if (tracing) place.trace(tracing->tracer);
    change(life, State::serving);
    place.serve(stop, life.progress);
    life.counters = place.counters();
    if (tracing) life.counters.traces.push_back(tracing->tracer.take(host, index));
}

void PlaceThreads::Threads::dispatch(Life& life) {
    const auto carrier = transport.carrier_of(any_place, [](const Failure&) {});
    auto tracing = trace(*carrier);
    Dispatcher dispatcher(host, run, network->graph.nodes.size(), rules, tracing ? tracing->carrier : *carrier);
    change(life, State::serving);
    dispatcher.serve(stop);
    life.counters = dispatcher.counters();
    if (tracing) life.counters.traces.push_back(tracing->tracer.take(host, any_place));
}

// A system may have no more threads for us. Then those that began must hear that they are to end, before they are
// joined.
void PlaceThreads::Threads::start() {
    try {
        for (std::uint32_t index = 0; index < lives.size(); ++index)
            threads.emplace_back([this, index] { serve(index); });
    } catch (const std::system_error& error) {
        const auto made = threads.size();
        stop = true;
        threads.clear();
        throw Error("only " + std::to_string(made) + " threads of " + std::to_string(lives.size()) +
                    " could be made (" + error.what() +
                    "); fewer places, or a higher limit of threads (ulimit -u, TasksMax), would help");
    }
}

// The first of them.
void PlaceThreads::Threads::tell(std::size_t end, Message::Type type, std::shared_ptr<const Plan> told_plan) {
    for (std::uint32_t index = 0; all_serve && index < end; ++index) {
        Message message;
        message.type = type;
        message.run = run;
        message.plan = told_plan;
        transport.tell(index < count ? index : any_place, std::move(message));
    }
}

PlaceThreads::PlaceThreads(PlaceTransport& transport, std::shared_ptr<const Network> network, std::uint64_t run,
                           std::string host, std::uint32_t count, Plan plan, Tuning rules, AskedFrom askers)
    : threads_(new Threads{transport, std::move(network), run, std::move(host), std::move(plan), rules, count,
                           std::vector<Threads::Life>(count + (askers == AskedFrom::other_hosts))}) {
    const auto& its = *threads_->network;
    const auto edges = asking_edges(its.graph, its.layers, its.registry).size();
    for (std::uint32_t i = 0; i < count; ++i) threads_->gauges.emplace_back(its.graph.nodes.size(), edges);
    threads_->start();
}

PlaceThreads::~PlaceThreads() {
    if (!threads_->threads.empty()) stop();
}

bool PlaceThreads::ready() {
    using State = Threads::State;
    auto& t = *threads_;
    std::size_t serving = 0;
    for (const auto& life : t.lives) {
        const State state = life.state;
        if (state == State::died) throw Error(life.died_of);
        serving += state == State::serving;
    }
    if (serving < t.lives.size()) return false;
    t.all_serve = true;
    return true;
}

void PlaceThreads::wait_until_ready() {
    while (!ready()) {
        threads_->news.wait(std::chrono::milliseconds(100));
        clear_news();
    }
}

void PlaceThreads::use(const Plan& plan) {
    threads_->tell(threads_->lives.size(), Message::Type::plan, std::make_shared<const Plan>(plan));
}

void PlaceThreads::begin_to_stop() {
    if (threads_->stop.exchange(true)) return;
    threads_->tell(threads_->lives.size(), Message::Type::stop, nullptr);  // wakes those that wait for messages
}

bool PlaceThreads::over() const {
    using State = Threads::State;
    return std::all_of(threads_->lives.begin(), threads_->lives.end(), [](const auto& life) {
        const State state = life.state;
        return state == State::ended || state == State::died;
    });
}

Counters PlaceThreads::stop() {
    begin_to_stop();
    threads_->threads.clear();
    Counters sum;
    for (const auto& life : threads_->lives) sum += life.counters;
    return sum;
}

std::vector<Failure> PlaceThreads::failures() {
    const std::lock_guard lock(threads_->failures_mutex);
    return std::exchange(threads_->failures, {});
}

void PlaceThreads::watch() {
    if (threads_->profiler) return;
    std::vector<const Gauge*> gauges;
    for (const auto& gauge : threads_->gauges) gauges.push_back(&gauge);
    try {
        threads_->profiler = std::make_unique<SamplingProfiler>(std::move(gauges));
    } catch (const std::system_error&) {  // no thread is to be had: the run goes on, and nobody sees what they are at
    }
}

HostFigures PlaceThreads::figures() const { return threads_->profiler ? threads_->profiler->figures() : HostFigures{}; }

std::uint32_t PlaceThreads::count() const { return threads_->count; }

std::uint64_t PlaceThreads::progress() const {
    std::uint64_t sum = 0;
    for (const auto& life : threads_->lives) sum += life.progress.load(std::memory_order_relaxed);
    return sum;
}

std::uint64_t PlaceThreads::pulse() const {
    std::uint64_t sum = 0;
    for (const auto& gauge : threads_->gauges) sum += gauge.pulse.get();
    return sum;
}

PlaceThreads::SoFar PlaceThreads::so_far() const {
    SoFar sum;
    for (const auto& gauge : threads_->gauges) {
        sum.rays += gauge.rays.get();
        sum.lived_ns += gauge.lived_ns.get();
        sum.waited_ns += gauge.waited_ns.get();
        sum.idle_ns += gauge.idle_ns.get();
    }
    return sum;
}

Doings PlaceThreads::doing() const { return threads_->network->activity->all(); }

int PlaceThreads::news() const { return threads_->news.handle(); }

void PlaceThreads::clear_news() { threads_->news.clear(); }

}  // namespace lightnet
