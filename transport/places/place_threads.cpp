#include "transport/places/place_threads.hpp"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

#include "core/base/error.hpp"
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

    PlaceTransport& transport;
    std::shared_ptr<const Network> network;
    std::uint64_t run;
    std::string host;
    Plan plan;
    Tuning rules;
    std::vector<Life> lives;  // by place
    Wakeup news{};
    bool all_serve = false;
    std::atomic<bool> stop{false};
    std::mutex failures_mutex{};
    std::vector<Failure> failures{};
    std::vector<std::jthread> threads{};

    void serve(std::uint32_t index);
    void change(Life& life, State state);
    void start(std::uint32_t count);
    void tell_all(Message::Type type, std::shared_ptr<const Plan> plan);
};

void PlaceThreads::Threads::change(Life& life, State state) {
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
        const auto carrier = transport.carrier_of(index, at_fault);
        Place place(*network, {host, index}, plan, run, rules, *carrier);
        change(life, State::serving);
        place.serve(stop, life.progress);
        life.counters = place.counters();
        change(life, State::ended);
    } catch (const std::exception& error) {
        life.died_of = "place " + std::to_string(index) + ": " + error.what();
        change(life, State::died);
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

void PlaceThreads::Threads::tell_all(Message::Type type, std::shared_ptr<const Plan> told_plan) {
    for (std::uint32_t place = 0; all_serve && place < lives.size(); ++place) {
        Message message;
        message.type = type;
        message.run = run;
        message.plan = told_plan;
        transport.tell(place, std::move(message));
    }
}

PlaceThreads::PlaceThreads(PlaceTransport& transport, std::shared_ptr<const Network> network, std::uint64_t run,
                           std::string host, std::uint32_t count, Plan plan, Tuning rules)
    : threads_(new Threads{transport, std::move(network), run, std::move(host), std::move(plan), rules,
                           std::vector<Threads::Life>(count)}) {
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
    threads_->tell_all(Message::Type::plan, std::make_shared<const Plan>(plan));
}

void PlaceThreads::begin_to_stop() {
    if (threads_->stop.exchange(true)) return;
    threads_->tell_all(Message::Type::stop, nullptr);  // wakes those that wait for messages
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

std::uint32_t PlaceThreads::count() const { return static_cast<std::uint32_t>(threads_->lives.size()); }

std::uint64_t PlaceThreads::progress() const {
    std::uint64_t sum = 0;
    for (const auto& life : threads_->lives) sum += life.progress.load(std::memory_order_relaxed);
    return sum;
}

int PlaceThreads::news() const { return threads_->news.handle(); }

void PlaceThreads::clear_news() { threads_->news.clear(); }

}  // namespace lightnet
