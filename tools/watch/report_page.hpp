// The report of a run as one page that needs neither network nor program.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/film/film.hpp"
#include "tools/pictures/output_file.hpp"
#include "tools/watch/watcher.hpp"

namespace lightnet {

/// They are shorter: of a larger picture, every second pixel is shown, or every third …
inline constexpr std::size_t most_report_bytes = 4'900'000;

/// What stands in its table: what, and how much.
using ReportFacts = std::vector<std::pair<std::string, std::string>>;

/// The page that shows a run and its film, with what was collected frozen into it. Throws Error when not even a pixel
/// fits.
std::string report_page(const Watcher& watcher, const Film& film, const ReportFacts& facts);

}  // namespace lightnet
