// The port to a node that the plan may put here or elsewhere.
#pragma once

#include <functional>
#include <utility>

#include "core/network/light/port.hpp"

namespace lightnet {

/// Asks a node where the plan has it now: at this place by a call, at others by bundles. Either way is made when it is
/// first needed. What was asked the one way is finished that way, whatever the plan says by then.
class PlannedPort final : public Port {
public:
    using Made = std::function<Port*()>;
    PlannedPort(Made call, Made bundles) : make_call_(std::move(call)), make_bundles_(std::move(bundles)) {}

    void use(bool here) { here_ = here; }

    Ticket begin(std::span<const Query> questions, std::span<Rgb> answers) override {
        Port*& way = here_ ? call_ : bundles_;
        if (!way) way = here_ ? make_call_() : make_bundles_();
        return way->begin(questions, answers);
    }
    // A call leaves nothing to be finished.
    void finish(Ticket ticket) override {
        if (ticket != 0) bundles_->finish(ticket);
    }
    void abandon(Ticket ticket) noexcept override {
        if (ticket != 0) bundles_->abandon(ticket);
    }

private:
    Made make_call_, make_bundles_;
    bool here_ = false;
    Port* call_ = nullptr;
    Port* bundles_ = nullptr;
};

}  // namespace lightnet
