// Figures of all places, put together for the report.
#pragma once

#include <vector>

#include "core/film/picture.hpp"
#include "core/network/graph/graph.hpp"
#include "core/run/message/place_record.hpp"
#include "tools/support/run_report.hpp"

namespace lightnet {

/// The nodes of a graph that do work, without figures.
std::vector<NodeReport> nodes_without_figures(const Graph& graph);

/// How much of the light of a picture each of its layers is.
std::vector<LayerReport> light_of_layers(const Picture& picture);

/// Adds up per node and per edge what the records say, and gives each place of the report its own.
void add_figures(RunReport& report, const std::vector<PlaceRecord>& records);

/// Seconds that the calling thread has run.
double seconds_of_this_thread();

}  // namespace lightnet
