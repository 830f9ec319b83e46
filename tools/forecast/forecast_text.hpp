// Forecasts, as people and programs read them.
#pragma once

#include <string>
#include <vector>

#include "core/run/forecast/forecast.hpp"

namespace lightnet {

/// One set of hosts.
struct ForecastRow {
    std::size_t hosts = 0, places = 0;
    Forecast what;
};

/// What is foreseen, and how well the recorded run itself was.
struct ForecastTable {
    std::string report;                 // file
    double recorded = 0, replayed = 0;  // seconds of the recorded run, and what was foreseen of it
    std::vector<std::string> nodes;     // names by index
    std::uint32_t width = 0, height = 0, samples = 0, frames = 1;
    std::vector<ForecastRow> rows;
};

/// The part of a forecast by which it may be wrong, 0.1 for 10 %: by as much as it was of the recorded run itself, 2 %
/// at least.
double doubt_in(const ForecastTable& table);
/// "3 h 10 min", "12.3 s".
std::string duration_text(double seconds);
std::string to_text(const ForecastTable& table);
/// See docs/schemas/forecast.schema.json.
std::string to_json(const ForecastTable& table);

}  // namespace lightnet
