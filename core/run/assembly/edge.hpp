// The asking end of an edge at one place, with all that looks at what goes over it.
#pragma once

#include <cstddef>
#include <optional>

#include "core/network/light/locks.hpp"
#include "core/network/light/port.hpp"
#include "core/run/assembly/edge_meter.hpp"

namespace lightnet {

class AccountKeeper;

/// Stands between a node and the port to one that it asks. What the asker has to keep to, and who keeps what is asked,
/// may each be absent. One thread's, as ports are.
class Edge final : public Port {
public:
    /// The ends, by node.
    struct Ends {
        std::size_t asker, asked;
        std::size_t width;  // colours per question
    };
    /// All outlive the edge.
    struct Watch {
        const Locks* locks = nullptr;  // nobody asks with one in hand
        EdgeMeter* meter = nullptr;
        AccountKeeper* keeper = nullptr;
    };
    Edge(const Ends& ends, Port& port, const Watch& watch);

    Ticket begin(std::span<const Query> questions, std::span<Rgb> answers) override;
    void finish(Ticket ticket) override;
    void abandon(Ticket ticket) noexcept override { port_.abandon(ticket); }

private:
    Ticket ask(std::span<const Query> questions, std::span<Rgb> answers);

    Ends ends_;
    Port& port_;
    Watch watch_;
    EdgeMeter::Measured* measured_;  // null: nothing is
};

}  // namespace lightnet
