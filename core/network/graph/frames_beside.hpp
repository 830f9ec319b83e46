// Scenes of a graph in the frames before and after its own.
#pragma once

#include <functional>

#include "core/network/graph/graph.hpp"

namespace lightnet {

/// Does a node of the graph ask how far surfaces move until the next frame?
bool asks_for_motion(const Graph& graph);

/// Notes at scenes what they are one frame before and after (see their parameters `previous`, `next` …), where that is
/// looked at: by an open shutter, or by a node that asks for motion. graph_at(by) gives the graph `by` frames later.
void note_frames_beside(Graph& graph, const std::function<Graph(int by)>& graph_at);

}  // namespace lightnet
