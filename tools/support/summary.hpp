// The last words of a run: what it made, where, how long it took and who took part.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/film/tone.hpp"
#include "core/network/graph/hosts.hpp"
#include "tools/support/run_report.hpp"

namespace lightnet {

/// What there is to sum up. All of it outlives the summary.
struct Ending {
    const RunReport& report;                 // finished
    const std::vector<std::string>& layers;  // of the picture
    const Hosts& asked;                      // hosts that were to take part
    Brightness brightness;                   // as the PNG shows it, where its stops were chosen, else of the picture
    double exposure = 0;                     // stops, as it was rendered
    std::optional<double> chosen{};          // stops by which the PNG was to be brighter than that
    double shown = 0;                        // stops by which it is
};

/// Some lines, without the last line break.
std::string summary_of(const Ending& ending);

/// What the page of a report says in its table. `at_work`: so many places were, on average while the run prepared and
/// rendered.
std::vector<std::pair<std::string, std::string>> facts_of(const RunReport& report, double at_work);

}  // namespace lightnet
