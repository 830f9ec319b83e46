// Results of races and sweeps, as tables, as CSV, and as a page.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/race/lap.hpp"

namespace lightnet {

/// How such files begin.
inline constexpr std::string_view laps_beginning = "name,seed,samples,seconds,relmse,mse,flip,blocks,bias\n";
inline constexpr std::string_view race_page_beginning = "<!DOCTYPE html>\n<!-- lightnet race -->\n";

/// A line for each run, columns below each other: samples, seconds, and errors where there is a reference.
std::string table_of(const std::vector<Lap>& laps);
/// All points of all curves, and for the end of each run what only its last picture was asked for.
std::string csv_of(const std::vector<Lap>& laps);

/// What a page of a race shows besides.
struct RacePage {
    std::string reference;      // file
    std::string reference_png;  // bytes
    double seconds = 0;         // that each run had
};
/// One file, which needs no other and no script: curves of relMSE over seconds (the median over seeds, and a band from
/// the least to the most), a table of where they ended, pictures and what FLIP finds in them.
std::string race_page(const std::vector<Lap>& laps, const RacePage& page);

}  // namespace lightnet
