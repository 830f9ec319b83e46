// The port to a node that the plan may put here or elsewhere.
#pragma once

#include <cstddef>
#include <functional>
#include <utility>

#include "core/network/light/port.hpp"

namespace lightnet {

/// Asks a node where the plan has it now: at this place by a call, at others by bundles. A node of this place that
/// others share with it is asked by bundles as well, and this place answers what the others don't take. Each way is
/// made when it is first needed. What was asked the one way is finished that way, whatever the plan says by then.
class RoutingPort final : public Port {
public:
    using Made = std::function<Port*()>;
    static constexpr std::size_t worth_sharing = 16;  // questions of an ask; fewer are called

    RoutingPort(Made call, Made bundles) : make_call_(std::move(call)), make_bundles_(std::move(bundles)) {}

    /// `shared`: others answer for this place, too.
    void use(bool here, bool shared) { here_ = here, shared_ = shared; }

    Ticket begin(std::span<const Query> questions, std::span<Rgb> answers) override {
        if (!here_ || (shared_ && questions.size() >= worth_sharing)) return bundles().begin(questions, answers);
        return call().begin(questions, answers);
    }
    // A call leaves nothing to be finished.
    void finish(Ticket ticket) override {
        if (ticket != 0) bundles_->finish(ticket);
    }
    void abandon(Ticket ticket) noexcept override {
        if (ticket != 0) bundles_->abandon(ticket);
    }

    /// The node of this place.
    Port& call() {
        if (!call_) call_ = make_call_();
        return *call_;
    }

private:
    Port& bundles() {
        if (!bundles_) bundles_ = make_bundles_();
        return *bundles_;
    }

    Made make_call_, make_bundles_;
    bool here_ = false, shared_ = false;
    Port* call_ = nullptr;
    Port* bundles_ = nullptr;
};

}  // namespace lightnet
