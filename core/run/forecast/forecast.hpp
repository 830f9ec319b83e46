// The forecast of a run on other hosts, from what one has cost.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/network/graph/plan.hpp"
#include "core/run/forecast/run_costs.hpp"

namespace lightnet {

/// A part of a run that could hold all others up.
struct BusyPart {
    enum class What { places, host, node, line, launcher_line, launcher_thread, preparing, alone };
    What what = What::places;
    std::string name;  // of the host or the node
    double share = 0;  // of the whole time, in which it was busy
    friend bool operator==(const BusyPart&, const BusyPart&) = default;
};

/// Seconds of all frames. A value.
struct Forecast {
    double seconds = 0;                                   // in all
    double load = 0, prepare = 0, render = 0, write = 0;  // of them
    double least = 0, most = 0;   // between which it will be, as far as pieces of the picture differ
    double work = 0;              // of threads at speed 1, on nodes and for preparing
    double efficiency = 0;        // work, over what all places could have done
    std::vector<double> by_node;  // of threads at speed 1
    std::vector<BusyPart> parts;  // the busiest one first
};

/// Plays the run: its tiles by a real MasterRenderer, what nodes prepare by real ShardDealers, and questions by real
/// Schedulers, on a simulated clock. `launcher`: its line. `rounds`: how often, each with other pieces of the picture
/// that are costly. Throws Error when a host of the plan is not among `hosts`.
Forecast forecast(const RunCosts& costs, const Plan& plan, const std::vector<ForecastHost>& hosts,
                  const LineCost& launcher, std::uint32_t rounds);

/// Costs of a smaller picture, where theirs has more blocks of usual tiles than that, with as much less to prepare:
/// layouts compare by them as by the whole, and are played quickly.
RunCosts shortened(const RunCosts& costs, double most_blocks);
/// Are nodes and hosts so few that layouts are played one by one? Else an estimate has to do.
bool are_played(const RunCosts& costs, const std::vector<ForecastHost>& hosts);

/// What to do about the busiest part, in a sentence.
std::string advice_for(const Forecast& forecast);
/// What it is, in words: "the line of host 'b'".
std::string words_for(const BusyPart& part);

}  // namespace lightnet
