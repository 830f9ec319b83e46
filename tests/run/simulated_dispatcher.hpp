// The dispatcher of a simulated host: a real one, between simulated lines.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "core/run/place/dispatcher.hpp"

namespace lightnet::test {

/// Knows from the beginning who answers for node 0: all places of its host.
class SimulatedDispatcher {
public:
    struct Hooks {
        std::function<void(std::uint32_t place, Message& ask)> deal;
        std::function<void(Message)> reply;
        std::function<double()> clock;
    };
    SimulatedDispatcher(const std::string& host, std::uint32_t places, Strategy strategy, Hooks hooks)
        : carrier_(hooks), dispatcher_(host, 0, 1, {}, carrier_, hooks.clock) {
        Plan plan;
        plan.places_of.resize(1);
        plan.strategy = strategy;
        for (std::uint32_t place = 0; place < places; ++place) {
            plan.places.push_back({host, place});
            plan.places_of[0].push_back(place);
        }
        Message message;
        message.type = Message::Type::plan;
        message.plan = std::make_shared<const Plan>(std::move(plan));
        hear(std::move(message));
    }

    void hear(Message message) {
        carrier_.arrived.push_back(std::move(message));
        step();
    }
    void step() { dispatcher_.step(); }

private:
    class DealingCarrier final : public Carrier {
    public:
        explicit DealingCarrier(Hooks hooks) : hooks_(std::move(hooks)) {}
        bool ask(const PlaceAt& to, Message& message) override {
            hooks_.deal(to.index, message);
            return true;
        }
        void reply(Message message) override { hooks_.reply(std::move(message)); }
        std::optional<Message> receive() override {
            if (arrived.empty()) return std::nullopt;
            Message message = std::move(arrived.front());
            arrived.pop_front();
            return message;
        }
        void wait(std::chrono::nanoseconds) override {}
        void forget(const PlaceAt&) override {}
        const Counters& counters() const override { return none_; }

        std::deque<Message> arrived;

    private:
        Hooks hooks_;
        Counters none_;
    };

    DealingCarrier carrier_;
    Dispatcher dispatcher_;
};

}  // namespace lightnet::test
