// Askers and replicas of a light operator on a clock of their own: what becomes of questions about light when replicas
// are slow, and when work runs out. Same seed, same story.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <memory>
#include <queue>
#include <random>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/run/schedule/multiplexer.hpp"

namespace lightnet::test {

/// What is asked, and of whom.
struct LightWorld {
    std::uint64_t seed = 1;
    std::vector<double> slowness{1, 1, 1, 1};  // of each replica: times as long as usual
    double slower_from = 1e9;                  // seconds; from then on the last replica takes ...
    double slower = 1;                         // ... so many times as long again
    std::size_t askers = 2;
    std::size_t fibers = 4;       // of each asker: they ask, wait, think, and ask again
    std::size_t asks = 400;       // of each asker; the fiber that is done with one takes the next
    std::size_t questions = 256;  // of each ask
    double seconds = 200e-6;      // that a question takes
    double thinking = 0.01;       // seconds between an answer and the next ask
    double delay = 0.0005;        // of each message
    bool double_tail = true;
};

/// What came of it.
struct LightStory {
    double seconds = 0;               // until the last answer
    std::uint64_t asked = 0;          // questions
    std::uint64_t answered = 0;       // by replicas, twice or not
    std::vector<std::uint64_t> by{};  // each of them
    Counters counters;
};

/// Plays it to its end.
class SimulatedLight {
public:
    explicit SimulatedLight(const LightWorld& world)
        : world_(world), random_(world.seed), replicas_(world.slowness.size()) {
        story_.by.resize(world_.slowness.size());
        for (std::size_t i = 0; i < world_.askers; ++i) askers_.push_back(std::make_unique<Asker>(*this));
    }

    LightStory play() {
        for (auto& asker : askers_)
            for (std::size_t fiber = 0; fiber < world_.fibers; ++fiber) think(*asker);
        while (unfinished()) {
            if (events_.empty() || now_ > 1e6) throw std::runtime_error("nothing comes to an end");
            Event event = events_.top();
            events_.pop();
            now_ = event.time;
            happen(event);
        }
        for (auto& asker : askers_) story_.counters += asker->counters;
        return story_;
    }

private:
    struct Asker;
    struct Line;
    struct Event {
        enum class Kind { thought, arrived, done, replied, tick };
        double time;
        Kind kind;
        Asker* asker = nullptr;
        std::size_t number = 0;  // of a replica
        Bundle<Query> bundle{};
        Line* line = nullptr;
        Load load{};
        std::uint64_t order = 0;
        bool operator<(const Event& other) const {
            return time != other.time ? time > other.time : order > other.order;
        }
    };
    // The channel of an asker to a replica.
    struct Line final : Channel<Query> {
        SimulatedLight& world;
        Asker& asker;
        std::size_t replica;
        Load known{};
        Line(SimulatedLight& w, Asker& a, std::size_t r) : world(w), asker(a), replica(r) {}
        bool send(const Bundle<Query>& bundle) override {
            world.schedule({world.now_ + world.world_.delay, Event::Kind::arrived, &asker, replica, bundle, this});
            return true;
        }
        Credit credit() const override { return {8, 8192}; }
        Load load() const override { return known; }
        std::string host() const override { return std::to_string(replica); }
    };
    struct Asker final : BundleOwner<Query> {
        SimulatedLight& world;
        Counters counters;
        Multiplexer<Query> replicas;
        std::vector<std::unique_ptr<Line>> lines;
        std::size_t begun = 0, done = 0;  // asks
        std::size_t thinking = 0;
        double next_tick = 0;
        explicit Asker(SimulatedLight& w) : world(w) {
            MultiplexerRules rules;
            rules.scheduling.double_tail = world.world_.double_tail;
            rules.scheduling.tail_part = 0.01;
            rules.clock = [this] { return world.now_; };
            replicas.follow(std::move(rules), &counters);
            std::vector<Channel<Query>*> channels;
            for (std::size_t i = 0; i < world.world_.slowness.size(); ++i)
                channels.push_back(lines.emplace_back(std::make_unique<Line>(world, *this, i)).get());
            replicas.use(std::move(channels));
        }
        void answered(const Bundle<Query>&, std::vector<Rgb>) override {
            ++done;
            if (begun < world.world_.asks) world.think(*this);
            world.story_.seconds = world.now_;
        }
        void failed(const Bundle<Query>&, const Failure& failure) override { throw std::runtime_error(failure.why); }
        void returned(Bundle<Query>) override {}
    };
    struct Replica {
        std::deque<Event> waiting;
        bool busy = false;
    };

    double part() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
    void schedule(Event event) {
        event.order = next_order_++;
        events_.push(std::move(event));
    }
    void think(Asker& asker) {
        ++asker.thinking;
        ++asker.begun;
        schedule({now_ + world_.thinking * 2 * part(), Event::Kind::thought, &asker});
    }
    bool unfinished() const {
        return std::any_of(askers_.begin(), askers_.end(),
                           [&](const auto& asker) { return asker->done < world_.asks; });
    }

    // As places do: who has nothing to do looks after what is late.
    void look_around(Asker& asker) {
        asker.replicas.foresee(asker.thinking == 0 && asker.replicas.half_idle() ? 0 : 1);
        asker.replicas.tick();
        const double next = now_ + std::chrono::duration<double>(asker.replicas.until_due()).count();
        if (asker.next_tick > now_ && asker.next_tick <= next) return;
        asker.next_tick = next;
        schedule({next, Event::Kind::tick, &asker});
    }

    void begin_next(std::size_t number) {
        auto& replica = replicas_[number];
        if (replica.busy || replica.waiting.empty()) return;
        Event event = std::move(replica.waiting.front());
        replica.waiting.pop_front();
        replica.busy = true;
        const bool last = number + 1 == replicas_.size();
        const double slowness = world_.slowness[number] * (last && now_ >= world_.slower_from ? world_.slower : 1);
        const double each = world_.seconds * slowness * (0.5 + part());
        event.time = now_ + each * static_cast<double>(event.bundle.questions->size());
        event.kind = Event::Kind::done;
        event.load.service_ns = static_cast<std::uint32_t>(std::min(4e9, each * 1e9));
        schedule(std::move(event));
    }

    void happen(Event& event) {
        switch (event.kind) {
            case Event::Kind::thought: {
                --event.asker->thinking;
                story_.asked += world_.questions;
                event.asker->replicas.send(
                    {std::make_shared<const std::vector<Query>>(world_.questions), event.asker, 1, 1});
                return look_around(*event.asker);
            }
            case Event::Kind::arrived: {
                const auto number = event.number;
                replicas_[number].waiting.push_back(std::move(event));
                return begin_next(number);
            }
            case Event::Kind::done: {
                const auto number = event.number;
                auto& replica = replicas_[number];
                replica.busy = false;
                story_.answered += event.bundle.questions->size();
                story_.by[number] += event.bundle.questions->size();
                for (const auto& other : replica.waiting)
                    event.load.fill += static_cast<std::uint32_t>(other.bundle.questions->size());
                event.kind = Event::Kind::replied;
                event.time = now_ + world_.delay;
                schedule(std::move(event));
                return begin_next(number);
            }
            case Event::Kind::replied:
                event.line->known = event.load;
                event.bundle.owner->answered(event.bundle, std::vector<Rgb>(event.bundle.questions->size()));
                return look_around(*event.asker);
            case Event::Kind::tick:
                return look_around(*event.asker);
        }
    }

    LightWorld world_;
    std::mt19937_64 random_;
    double now_ = 0;
    std::vector<Replica> replicas_;
    std::vector<std::unique_ptr<Asker>> askers_;
    std::priority_queue<Event> events_;
    std::uint64_t next_order_ = 1;
    LightStory story_;
};

}  // namespace lightnet::test
