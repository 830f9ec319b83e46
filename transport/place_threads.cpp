#include "transport/place_threads.hpp"

#include <atomic>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <zmq.hpp>

#include "core/base/error.hpp"
#include "transport/descriptors.hpp"
#include "transport/sockets.hpp"
#include "transport/wakeup.hpp"
#include "transport/zmq_carrier.hpp"

namespace lightnet {
namespace {

constexpr std::size_t sockets_per_place = 3;  // where it answers, its way to other hosts, and ours to it
constexpr std::size_t other_descriptors = 8;

}  // namespace

struct PlaceThreads::Threads {
    enum class State { starting, serving, died, ended };
    // What a place tells this process, without a socket: it must be able to tell that there are none left.
    struct Life {
        std::atomic<State> state{State::starting};
        std::atomic<std::uint64_t> progress{0};
        Counters counters;  // these two are written before `state` says that it has ended or died
        std::string died_of;
    };

    zmq::context_t& context;
    std::shared_ptr<const Network> network;
    std::uint64_t run;
    std::string host;
    Plan plan;
    Tuning rules;
    std::vector<Life> lives;  // by place
    Wakeup news{};
    std::vector<zmq::socket_t> to{};
    std::atomic<bool> stop{false};
    std::mutex failures_mutex{};
    std::vector<Failure> failures{};
    std::vector<std::jthread> threads{};

    void serve(std::uint32_t index);
    void tell(Life& life, State state);
    void start(std::uint32_t count);
};

void PlaceThreads::Threads::tell(Life& life, State state) {
    life.state = state;
    news.notify();
}

void PlaceThreads::Threads::serve(std::uint32_t index) {
    auto& life = lives[index];
    try {
        const auto at_fault = [this](const Failure& failure) {
            const std::lock_guard lock(failures_mutex);
            failures.push_back(failure);
            news.notify();
        };
        ZmqCarrier carrier(context, {run, host, true, index, at_fault});
        Place place(*network, {host, index}, plan, run, rules, carrier);
        tell(life, State::serving);
        place.serve(stop, life.progress);
        life.counters = place.counters();
        tell(life, State::ended);
    } catch (const std::exception& error) {
        life.died_of = "place " + std::to_string(index) + ": " + error.what();
        tell(life, State::died);
    }
}

// A system may have no more threads for us. Then those that began must hear that they are to end, before they are
// joined.
void PlaceThreads::Threads::start(std::uint32_t count) {
    try {
        for (std::uint32_t index = 0; index < count; ++index) threads.emplace_back([this, index] { serve(index); });
    } catch (const std::system_error& error) {
        const auto made = threads.size();
        stop = true;
        threads.clear();
        throw Error("only " + std::to_string(made) + " threads of " + std::to_string(count) + " could be made (" +
                    error.what() + "); fewer places, or a higher limit of threads (ulimit -u, TasksMax), would help");
    }
}

PlaceThreads::PlaceThreads(zmq::context_t& context, std::shared_ptr<const Network> network, std::uint64_t run,
                           std::string host, std::uint32_t count, Plan plan, Tuning rules) {
    want_descriptors(sockets_per_place * count + other_descriptors, std::to_string(count) + " places");
    threads_.reset(new Threads{context, std::move(network), run, std::move(host), std::move(plan), rules,
                               std::vector<Threads::Life>(count)});
    threads_->start(count);
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
    // inproc sockets connect only to what is bound, and all places have bound by now.
    while (t.to.size() < count())
        t.to.push_back(asking_socket(t.context, inproc_endpoint(t.run, static_cast<std::uint32_t>(t.to.size()))));
    return true;
}

void PlaceThreads::wait_until_ready() {
    while (!ready()) {
        std::vector<zmq_pollitem_t> items{readable(news())};
        poll(items, std::chrono::milliseconds(100));
        clear_news();
    }
}

void PlaceThreads::use(const Plan& plan) {
    const auto shared = std::make_shared<const Plan>(plan);
    for (auto& socket : threads_->to) {
        Message message;
        message.type = Message::Type::plan;
        message.run = threads_->run;
        message.plan = shared;
        Frames frames;
        frames.push_back(frame_of(std::move(message)));
        send_frames(socket, frames);
    }
}

void PlaceThreads::begin_to_stop() {
    auto& t = *threads_;
    if (t.stop.exchange(true)) return;
    for (auto& socket : t.to) {  // wakes those that wait for messages
        Message message;
        message.type = Message::Type::stop;
        message.run = t.run;
        Frames frames;
        frames.push_back(frame_of(std::move(message)));
        send_frames(socket, frames);
    }
}

Counters PlaceThreads::stop() {
    begin_to_stop();
    auto& t = *threads_;
    t.threads.clear();
    Counters sum;
    for (const auto& life : t.lives) sum += life.counters;
    return sum;
}

std::vector<Failure> PlaceThreads::failures() {
    const std::lock_guard lock(threads_->failures_mutex);
    return std::exchange(threads_->failures, {});
}

std::uint32_t PlaceThreads::count() const { return static_cast<std::uint32_t>(threads_->lives.size()); }

std::uint64_t PlaceThreads::progress() const {
    std::uint64_t sum = 0;
    for (const auto& life : threads_->lives) sum += life.progress.load(std::memory_order_relaxed);
    return sum;
}

zmq::socket_t& PlaceThreads::to(std::uint32_t place) { return threads_->to.at(place); }

int PlaceThreads::news() const { return threads_->news.handle(); }

void PlaceThreads::clear_news() { threads_->news.clear(); }

}  // namespace lightnet
