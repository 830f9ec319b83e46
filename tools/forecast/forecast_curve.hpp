// The forecast of a run on fewer and on more places, as a curve.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/network/graph/kind.hpp"
#include "tools/forecast/forecast_hosts.hpp"
#include "tools/forecast/forecast_text.hpp"
#include "tools/forecast/recorded_run.hpp"

namespace lightnet {

/// Forecasts by number of places, and what was measured. A value; empty: there is nothing to foresee from.
struct ForecastCurve {
    std::uint32_t per_host = 1;     // places
    std::vector<ForecastRow> rows;  // 1, 2, 4, … places
    std::size_t places = 0;         // of the recorded run
    double seconds = 0;             // that it took, from loading to writing
    double doubt = 0;               // the part by which all may be wrong, see doubt_in()
};

/// What a run takes on these hosts. Throws UserError where one of them has not the memory.
ForecastRow foreseen_on(const ForecastCrew& crew, const RecordedRun& run, const RunCosts& costs,
                        const LineCost& launcher, const Registry& registry);

/// Of the run that this x.run.json tells of, on hosts with as many places as its own had, by lines of 1 Gbit/s and
/// 0.2 ms. Empty where the report tells too little. Takes some tenths of a second.
ForecastCurve curve_of_run(const std::filesystem::path& report, const Registry& registry);

}  // namespace lightnet
