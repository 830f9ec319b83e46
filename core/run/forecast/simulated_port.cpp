#include "core/run/forecast/simulated_port.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/run/message/tuning.hpp"
#include "core/run/place/full_bundle.hpp"
#include "core/run/place/relief_terms.hpp"

namespace lightnet {
SimulatedPort::SimulatedPort(EventQueue& events, Target target, Strategy strategy, SimulatedReplicas::Send send)
    : events_(events), target_(std::move(target)), replicas_(events, strategy, std::move(send)) {}

bool SimulatedPort::ask(double questions, std::function<void()> answered) {
    carried_ += questions;
    const auto whole = static_cast<std::size_t>(carried_);
    if (whole == 0) return false;
    carried_ -= static_cast<double>(whole);
    if (waiting_ == 0) oldest_ = events_.now();
    parts_.push_back({std::make_shared<Ask>(Ask{whole, std::move(answered)}), whole});
    waiting_ += whole;
    return true;
}

// The first questions that wait, as one bundle.
SimulatedAsk SimulatedPort::take(std::size_t questions) {
    auto bundle = std::make_shared<std::vector<Part>>();
    waiting_ -= questions;
    for (std::size_t left = questions; left > 0;) {
        auto& first = parts_.front();
        const auto some = std::min(left, first.questions);
        bundle->push_back({first.ask, some});
        left -= some;
        if (some == first.questions)
            parts_.pop_front();
        else
            first.questions -= some;
    }
    oldest_ = events_.now();
    return {target_.node, static_cast<double>(questions), 1, [this, bundle](const SimulatedLoad&) {
                for (const auto& part : *bundle)
                    if ((part.ask->left -= part.questions) == 0) part.ask->answered();
                target_.heard();
            }};
}

void SimulatedPort::send(std::size_t questions) { replicas_.add(take(questions)); }

std::size_t SimulatedPort::full() const {
    const double each = target_.own_seconds > 0 ? target_.own_seconds : replicas_.scheduler().order().times().said();
    return full_bundle(Tuning{}.bundle, each);
}

void SimulatedPort::flush(bool idle) {
    if (target_.own_seconds > 0) return share_out();
    while (waiting_ >= full()) send(full());
    const bool old = events_.now() - oldest_ > 1e-6 * Tuning{}.oldest_us;
    const bool eager = idle && replicas_.scheduler().in_flight().copies() < Tuning{}.eager * replicas_.places();
    if (waiting_ > 0 && (old || eager)) send(waiting_);
}

void SimulatedPort::share_out() {
    while (waiting_ > 0) {
        const auto size =
            std::min({full(), std::max(waiting_ / (2 * (target_.helpers + 1)), relief::least_bundle), waiting_});
        if (!relief::may_go(replicas_.scheduler().order(), size, waiting_, target_.own_seconds)) {
            if (events_.now() - faded_ >= relief::fades_in) faded_ = events_.now(), replicas_.fade(relief::fades_in);
            return;
        }
        send(size);
    }
}

std::optional<SimulatedAsk> SimulatedPort::take_own() {
    if (target_.own_seconds <= 0 || waiting_ == 0 || own_ >= relief::most_own) return std::nullopt;
    const auto most =
        relief::piece_of_own(target_.own_seconds, waiting_, target_.helpers, Tuning{}.bundle, target_.asks_on);
    ++own_;
    auto ask = take(std::min(waiting_, most));
    ask.answered = [this, answered = std::move(ask.answered)](const SimulatedLoad& load) {
        --own_;
        answered(load);
    };
    return ask;
}

}  // namespace lightnet
