// The mover of a run: decides, from what was measured of late, which nodes go to other hosts, and when that pays.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/run/forecast/measured_costs.hpp"
#include "core/run/forecast/placement.hpp"

namespace lightnet {

/// What a run was laid out by. A value.
struct LaidOut {
    RunCosts costs;
    std::vector<ForecastHost> hosts;
    LineCost launcher{};
    HeldByHosts holds;
};

/// A layout that is to follow the one in force. A value.
struct Move {
    HeldByHosts holds;
    double gain = 0;               // of the time that is left: 0 to 1, as predicted
    double seconds = 0;            // the same, in seconds
    double cost = 0;               // seconds, of moving
    std::vector<std::string> who;  // "caustic goes from a to b", one for each node that moves
};

/// Knows no clock, and does nothing: whoever asks it says when, and makes of the answer a plan. Where every host has
/// room for everything, there is nothing else to move to. Moves nothing that gains less than a fifth of the time left,
/// or costs more than half of what it gains; and after each move it waits, twice as long each time, until all has been
/// quiet for long. Where a node has lost its last host, it waits for nothing. One thread's.
class Mover {
public:
    using Time = double;  // seconds, of any clock that goes forward

    explicit Mover(LaidOut by);
    Mover(const Mover&) = delete;
    Mover& operator=(const Mover&) = delete;

    /// Takes in what was measured in about a second that ends now. None: all stays where it is.
    std::optional<Move> look(Time now, const RunWindow& window);
    /// False: every host has room for everything, and holds it, so nothing will ever move.
    bool may_move() const;
    /// By what the run is laid out now: with what each host holds, as of the last move.
    const LaidOut& by() const { return by_; }

private:
    std::optional<Move> better(Time now, const RunWindow& window) const;
    double gain_when_played(const RunCosts& costs, const std::vector<ForecastHost>& hosts, const HeldByHosts& before,
                            const HeldByHosts& after) const;
    double cost_of(Time now, const HeldByHosts& holds) const;
    bool keeps(std::size_t host, std::size_t node, Time now) const;
    void take_up(const HeldByHosts& holds, Time now);
    std::vector<std::string> words_for(const HeldByHosts& holds) const;

    LaidOut by_;
    MeasuredCosts measured_;
    bool fits_ = true;                     // every host has room for everything
    Time next_ = 0;                        // no move before that
    Time calm_ = 0;                        // when it is one move calmer
    int moves_ = 0;                        // of late
    double wanted_ = 0;                    // gains of moves that the looks of late have all wanted
    std::vector<std::vector<Time>> left_;  // by host and node: when it left
};

}  // namespace lightnet
