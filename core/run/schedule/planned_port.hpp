// The port to a node that the plan may put here or elsewhere.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <utility>

#include "core/network/light/port.hpp"

namespace lightnet {

/// What other places would take off this one, which holds the node itself.
struct Relief {
    std::size_t questions = 0;  // at most; 0: nobody has time to spare, or there is nobody
    double part = 0;            // of each ask
};

/// Asks a node where the plan has it now: at this place by a call, at others by bundles. Where others have time to
/// spare and this place has not, they get some of the questions, and the rest is called meanwhile. Each way is made
/// when it is first needed. What was asked the one way is finished that way, whatever the plan says by then.
class PlannedPort final : public Port {
public:
    using Made = std::function<Port*()>;
    /// `width`: colours of an answer.
    PlannedPort(Made call, Made bundles, std::size_t width)
        : make_call_(std::move(call)), make_bundles_(std::move(bundles)), width_(width) {}

    void use(bool here) { here_ = here, relief_ = {}; }
    /// What others take from now on, until it is said anew.
    void relieve(Relief relief) { relief_ = relief; }

    Ticket begin(std::span<const Query> questions, std::span<Rgb> answers) override {
        if (!here_) return bundles().begin(questions, answers);
        if (relief_.questions == 0) [[likely]]
            return call().begin(questions, answers);
        return begin_both(questions, answers);
    }
    // A call leaves nothing to be finished.
    void finish(Ticket ticket) override {
        if (ticket != 0) bundles_->finish(ticket);
    }
    void abandon(Ticket ticket) noexcept override {
        if (ticket != 0) bundles_->abandon(ticket);
    }

private:
    Port& call() {
        if (!call_) call_ = make_call_();
        return *call_;
    }
    Port& bundles() {
        if (!bundles_) bundles_ = make_bundles_();
        return *bundles_;
    }

    // DECISIONS: relief-by-the-idle
    Ticket begin_both(std::span<const Query> questions, std::span<Rgb> answers) {
        const auto part = static_cast<std::size_t>(relief_.part * static_cast<double>(questions.size()));
        const std::size_t away = std::min(part, relief_.questions);
        relief_.questions -= away;
        if (away == 0) return call().begin(questions, answers);
        const Ticket ticket = bundles().begin(questions.first(away), answers.first(away * width_));
        if (away == questions.size()) return ticket;
        try {
            call().begin(questions.subspan(away), answers.subspan(away * width_));
        } catch (...) {
            bundles_->abandon(ticket);
            throw;
        }
        return ticket;
    }

    Made make_call_, make_bundles_;
    std::size_t width_;
    bool here_ = false;
    Relief relief_;
    Port* call_ = nullptr;
    Port* bundles_ = nullptr;
};

}  // namespace lightnet
