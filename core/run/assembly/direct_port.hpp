// The port to a node of the same place: a function call.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "core/network/light/light_op.hpp"
#include "core/network/light/port.hpp"
#include "core/run/assembly/gauge.hpp"

namespace lightnet {

/// A node that can be called.
struct Callee {
    const LightOp& light;
    const std::string& name;              // as in the graph
    std::size_t layers = 1;               // colours per answer when nothing is added up
    bool whole = false;                   // it looks at the sockets by itself: long asks are not cut
    std::uint64_t* not_finite = nullptr;  // counts its answers that are infinite or no numbers
    std::uint64_t* unsound = nullptr;     // counts questions whose numbers are not finite
    Gauge* gauge = nullptr;               // of the place: says when it is at work
    Gauge::Doing doing = Gauge::asking;   // what it then says
    bool space = true;                    // it answers about points in media, too
};

/// Calls the node. Long asks are cut into chunks, between which the place may look at its sockets; an answer does not
/// depend on its neighbours, so nobody can tell.
class DirectPort final : public Port {
public:
    /// `width` colours per question are wanted: as many as the node has, or one, their sum. Counts questions in
    /// `count`. `pause` is called between chunks; it may be empty.
    DirectPort(Callee node, std::size_t width, std::uint64_t& count, std::function<void()> pause = {});

    Ticket begin(std::span<const Query> questions, std::span<Rgb> answers) override;
    void finish(Ticket) override {}
    void abandon(Ticket) noexcept override {}

private:
    Callee node_;
    std::size_t width_;
    std::uint64_t& count_;
    std::function<void()> pause_;
};

/// Asks `node` and adds its layers up, first to last, when one colour is wanted. Questions whose numbers are not finite
/// may come from anybody: the node is not asked, and the answer is black. Throws Error with the node's name when
/// it throws, and when it leaves the thread's floating-point mode changed: its own and all later answers would depend
/// on where it ran.
void answer(const Callee& node, std::size_t width, std::span<const Query> questions, std::span<Rgb> answers);

}  // namespace lightnet
