// The port to a node of the same place: a function call.
#pragma once

#include <cstdint>
#include <functional>

#include "core/light/light_op.hpp"
#include "core/light/port.hpp"

namespace lightnet {

/// Calls the node. Long asks are cut into pieces, between which the place may look at its sockets; an answer does not
/// depend on its neighbours, so nobody can tell.
class CallPort final : public Port {
public:
    /// `node` answers with `layers` colours per question; the asker wants `width`: as many, or one, their sum.
    /// `pause` is called between pieces; it may be empty.
    CallPort(const LightOp& node, std::size_t layers, std::size_t width, std::uint64_t& count,
             std::function<void()> pause = {});

    Ticket begin(std::span<const Query> questions, std::span<Rgb> answers) override;
    void finish(Ticket) override {}
    void abandon(Ticket) noexcept override {}

private:
    const LightOp& node_;
    std::size_t layers_, width_;
    std::uint64_t& count_;
    std::function<void()> pause_;
};

/// Asks `node`, which keeps `layers` colours per question apart, and adds them up, first to last, when one is wanted.
/// Throws Error when the node leaves the thread's floating-point mode changed: its own and all later answers would
/// depend on where it ran.
void answer(const LightOp& node, std::size_t layers, std::size_t width, std::span<const Query> questions,
            std::span<Rgb> answers);

}  // namespace lightnet
