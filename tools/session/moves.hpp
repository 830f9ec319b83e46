// The moves of a run: what hosts say of their work goes to a Mover, and what that decides becomes a plan.
#pragma once

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "core/network/graph/graph.hpp"
#include "core/network/graph/hosts.hpp"
#include "core/network/graph/kind.hpp"
#include "core/network/graph/plan.hpp"
#include "core/run/forecast/mover.hpp"
#include "core/run/forecast/run_meter.hpp"
#include "transport/launcher/cluster.hpp"

namespace lightnet {

/// Of a run that was laid out by itself. One thread's.
class Moves {
public:
    /// All of it outlives this; `hosts` are those of the layout.
    struct Of {
        const Graph& graph;
        const Registry& registry;
        const Hosts& hosts;
    };
    Moves(const LaidOut& by, Of of);

    /// For the hosts that are there. Each has all its places, also where nodes have left them: they answer what they
    /// have.
    Plan plan(const std::vector<HostOffer>& there) const;
    /// Looks at what hosts have done, about once a second; called as often as one likes. `now`: seconds; `done`: of the
    /// picture, 0 to 1; `left`: seconds that the run may still take. None: nothing moves.
    std::optional<Move> look(double now, const std::function<std::vector<HostState>()>& hosts, double done,
                             double left);
    bool may_move() const { return mover_.may_move(); }
    /// Has anything moved since the last call?
    bool take_change() { return std::exchange(changed_, false); }

private:
    Of of_;
    Mover mover_;
    RunMeter meter_;
    double next_look_ = 0;
    bool changed_ = false;
};

}  // namespace lightnet
