#include "core/run/forecast/simulated_replicas.hpp"

#include <algorithm>
#include <cmath>

#include "core/run/message/tuning.hpp"

namespace lightnet {
namespace {

Scheduler::Rules rules_with(Strategy strategy) {
    Scheduler::Rules rules;
    rules.strategy = strategy;
    rules.patience = rules.patience_at_first = EventQueue::never;  // all of them work at what they have
    return rules;
}

std::size_t counted(double questions) { return std::max<std::size_t>(1, std::size_t(std::llround(questions))); }

}  // namespace

SimulatedReplicas::SimulatedReplicas(EventQueue& events, Strategy strategy, Send send)
    : events_(events), send_(std::move(send)), scheduler_(rules_with(strategy)) {}

void SimulatedReplicas::join(Scheduler::Host host, std::uint32_t places, bool within_process) {
    const Tuning usual;
    Scheduler::Joined joined{joined_, host, joined_ + 1, {}};
    joined.credit = {places * usual.credit, places * usual.credit_questions, places * usual.credit_bytes};
    joined.places = places;
    joined.within_process = within_process;
    ++joined_;
    tell(joined);
}

void SimulatedReplicas::add(SimulatedAsk ask) {
    Scheduler::Added added{.work = next_++, .questions = counted(ask.questions)};
    added.region = added.work;
    asks_.emplace(added.work, std::move(ask));
    tell(added);
    tick();
}

void SimulatedReplicas::tell(const Scheduler::Event& event) { scheduler_.on(event, events_.now(), actions_); }

// What is sent may be answered before this returns.
void SimulatedReplicas::tick() {
    tell(Scheduler::Tick{});
    const auto actions = std::exchange(actions_, {});
    for (const auto& action : actions) {
        const auto* send = std::get_if<Scheduler::Send>(&action);
        if (!send) continue;
        SimulatedAsk ask = asks_.at(send->work);
        ask.answered = [this, copy = send->copy](const SimulatedLoad& load) { replied(copy, load); };
        send_(send->replica, std::move(ask));
    }
}

void SimulatedReplicas::replied(Scheduler::CopyId copy, const SimulatedLoad& load) {
    tell(Scheduler::Replied{.copy = copy, .fill = load.fill, .service = load.service});
    const auto actions = std::exchange(actions_, {});
    tick();
    for (const auto& action : actions)
        if (const auto* accept = std::get_if<Scheduler::Accept>(&action)) {
            const auto ask = asks_.extract(accept->work);
            ask.mapped().answered(load);
        }
}

}  // namespace lightnet
