#include "core/run/forecast/simulated_place.hpp"

#include <algorithm>
#include <utility>

#include "core/run/message/tuning.hpp"

namespace lightnet {
namespace {

// Of the place's own thread, for each piece of work that it takes and answers.
constexpr double seconds_of_message = 2e-5;

}  // namespace

SimulatedPlace::SimulatedPlace(EventQueue& events, SharedProcessors& processors, const RunCosts& costs,
                               const PlaceWork& kind)
    : events_(events),
      processors_(processors),
      costs_(costs),
      kind_(kind),
      inboxes_(costs.nodes.size()),
      by_node_(costs.nodes.size(), 0) {
    for (const auto node : costs.order)
        if (kind.holds[node]) by_rank_.push_back(node);
}

SimulatedPort* SimulatedPlace::port(std::size_t node) {
    const auto found = ports_.find(node);
    return found == ports_.end() ? nullptr : found->second.get();
}

SimulatedPort& SimulatedPlace::connect(std::size_t node, std::size_t helpers, Strategy strategy,
                                       SimulatedReplicas::Send send) {
    const double own = kind_.holds[node] ? kind_.light[node].seconds / processors_.speed() : 0;
    const bool asks_on = std::ranges::any_of(costs_.edges, [&](const auto& edge) { return edge.from == node; });
    return *ports_
                .emplace(node, std::make_unique<SimulatedPort>(
                                   events_, SimulatedPort::Target{node, own, helpers, asks_on, [this] { go_on(); }},
                                   strategy, std::move(send)))
                .first->second;
}

void SimulatedPlace::take(SimulatedAsk ask) {
    auto& inbox = inboxes_[ask.node];
    inbox.questions += ask.questions;
    inbox.waiting.push_back(std::move(ask));
    go_on();
}

void SimulatedPlace::flush(bool idle) {
    for (auto& [node, port] : ports_) port->flush(idle);
}

void SimulatedPlace::go_on() {
    if (busy_) return;
    flush(false);
    if (start_first(false) || start_own() || start_first(true)) return;
    flush(true);
}

bool SimulatedPlace::start_first(bool images) {
    for (const auto node : by_rank_) {
        auto& inbox = inboxes_[node];
        if ((node == costs_.image) != images || inbox.waiting.empty()) continue;
        if (inbox.fibers > 0 && spare_in_use_ >= Tuning{}.spare_fibers) continue;
        spare_in_use_ += inbox.fibers++ > 0;
        SimulatedAsk ask = std::move(inbox.waiting.front());
        inbox.waiting.pop_front();
        start(std::move(ask), true);
        return true;
    }
    return false;
}

bool SimulatedPlace::start_own() {
    for (auto& [node, port] : ports_)
        if (auto ask = port->take_own()) {
            start(std::move(*ask), false);
            return true;
        }
    return false;
}

// `counted`: somebody else has asked, and it takes a fiber.
void SimulatedPlace::start(SimulatedAsk ask, bool counted) {
    busy_ = true;
    const auto& work = kind_.light[ask.node];
    const double much = ask.questions * ask.times, seconds = much * work.seconds + seconds_of_message;
    const double begun = events_.now();
    for (std::size_t node = 0; node < by_node_.size(); ++node)
        by_node_[node] += much / processors_.speed() * work.own[node];
    processors_.work(seconds, [this, ask = std::move(ask), counted, begun] {
        busy_ = false;
        busy_seconds_ += events_.now() - begun;
        computed(ask, counted);
        go_on();
    });
}

void SimulatedPlace::computed(const SimulatedAsk& ask, bool counted) {
    const auto& asked = kind_.light[ask.node].asked;
    if (asked.empty()) return finish(ask, counted);
    const auto missing = std::make_shared<std::size_t>(1);
    const auto answered = [this, missing, ask, counted] {
        if (--*missing == 0) finish(ask, counted);
    };
    for (const auto& [node, questions] : asked)
        if (const auto found = port(node); found && found->ask(ask.questions * questions, answered)) ++*missing;
    if (--*missing == 0) finish(ask, counted);
}

void SimulatedPlace::finish(const SimulatedAsk& ask, bool counted) {
    auto& inbox = inboxes_[ask.node];
    if (counted) {
        inbox.questions -= ask.questions;
        spare_in_use_ -= --inbox.fibers > 0;
    }
    ask.answered({static_cast<std::size_t>(std::max(inbox.questions, 0.0)),
                  ask.times * kind_.light[ask.node].seconds / processors_.speed()});
}

}  // namespace lightnet
