// The work of a place, by what it holds: what runs there for a question, and what is asked of others for it.
#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "core/network/graph/plan.hpp"
#include "core/run/forecast/run_costs.hpp"

namespace lightnet {

/// Of a question to one node.
struct QuestionWork {
    double seconds = 0;                   // at this place, with all nodes that are called there
    std::map<std::size_t, double> asked;  // questions to others, or to whoever relieves this place, by node
    std::vector<double> own;              // of `seconds`: of each node of the graph
};

/// Places that hold the same nodes, and whom others relieve of the same.
struct PlaceWork {
    std::vector<bool> holds;   // by node
    std::vector<bool> shares;  // likewise: nodes that it holds, and that others answer as well who have less to do
    std::vector<QuestionWork> light;  // by node; of those that it holds
};

/// The kinds of places of a plan, and which place is of which.
struct PlaceKinds {
    std::vector<PlaceWork> kinds;
    std::vector<std::size_t> of_place;
};

/// Does one hold all nodes of the other?
bool holds_all_of(const std::vector<bool>& one, const std::vector<bool>& other);

/// What places do by the rules of Place: what they hold is called, unless others hold it who hold less.
PlaceKinds place_kinds(const RunCosts& costs, const Plan& plan);

/// Questions that each node answers for one block of a usual tile, wherever: 1 for the renderer.
std::vector<double> questions_of_block(const RunCosts& costs);
/// Seconds of work of a picture at speed 1, by node, without preparing.
std::vector<double> work_by_node(const RunCosts& costs);
/// Blocks of samples of all tiles of one frame, as many usual tiles.
double usual_blocks(const PictureCost& picture);

}  // namespace lightnet
