#include "core/run/forecast/place_work.hpp"

#include <algorithm>
#include <set>

#include "core/film/tile.hpp"

namespace lightnet {
namespace {

using NodeSet = std::vector<bool>;

std::vector<NodeSet> held_by_places(const RunCosts& costs, const Plan& plan) {
    std::vector<NodeSet> held(plan.places.size(), NodeSet(costs.nodes.size(), false));
    for (std::size_t node = 0; node < plan.places_of.size(); ++node)
        for (const auto place : plan.places_of[node]) held[place][node] = true;
    return held;
}

// Nodes that another kind of place holds, which lacks one of those of this kind.
NodeSet relieved(const NodeSet& mine, const std::set<NodeSet>& kinds) {
    NodeSet relieved_nodes(mine.size(), false);
    for (const auto& other : kinds) {
        if (holds_all_of(other, mine)) continue;
        for (std::size_t node = 0; node < mine.size(); ++node)
            if (mine[node] && other[node]) relieved_nodes[node] = true;
    }
    return relieved_nodes;
}

QuestionWork work_of(std::size_t node, const RunCosts& costs, const PlaceWork& place) {
    QuestionWork work{costs.nodes[node].seconds, {}, std::vector<double>(costs.nodes.size(), 0)};
    work.own[node] = work.seconds;
    for (const auto& edge : costs.edges) {
        if (edge.from != node || edge.questions <= 0) continue;
        if (!place.holds[edge.to] || place.shares[edge.to]) {
            work.asked[edge.to] += edge.questions;
            continue;
        }
        const auto& called = place.light[edge.to];
        work.seconds += edge.questions * called.seconds;
        for (const auto& [asked, questions] : called.asked) work.asked[asked] += edge.questions * questions;
        for (std::size_t i = 0; i < work.own.size(); ++i) work.own[i] += edge.questions * called.own[i];
    }
    return work;
}

}  // namespace

bool holds_all_of(const std::vector<bool>& one, const std::vector<bool>& other) {
    for (std::size_t node = 0; node < one.size(); ++node)
        if (other[node] && !one[node]) return false;
    return true;
}

PlaceKinds place_kinds(const RunCosts& costs, const Plan& plan) {
    const auto held = held_by_places(costs, plan);
    const std::set<NodeSet> different(held.begin(), held.end());
    PlaceKinds all;
    std::map<NodeSet, std::size_t> number;
    for (const auto& holds : different) {
        number.emplace(holds, all.kinds.size());
        auto& kind = all.kinds.emplace_back(
            PlaceWork{holds, relieved(holds, different), std::vector<QuestionWork>(holds.size())});
        for (const auto node : costs.order)
            if (holds[node]) kind.light[node] = work_of(node, costs, kind);
    }
    for (const auto& holds : held) all.of_place.push_back(number.at(holds));
    return all;
}

std::vector<double> questions_of_block(const RunCosts& costs) {
    std::vector<double> questions(costs.nodes.size(), 0);
    questions[costs.image] = 1;
    for (auto node = costs.order.rbegin(); node != costs.order.rend(); ++node)
        for (const auto& edge : costs.edges)
            if (edge.from == *node) questions[edge.to] += questions[*node] * edge.questions;
    return questions;
}

double usual_blocks(const PictureCost& picture) {
    const double tiles = double(picture.width) * picture.height / (double(picture.tile) * picture.tile);
    return tiles * ((picture.samples + samples_per_block - 1) / samples_per_block);
}

std::vector<double> work_by_node(const RunCosts& costs) {
    auto work = questions_of_block(costs);
    for (std::size_t node = 0; node < work.size(); ++node)
        work[node] *= costs.nodes[node].seconds * usual_blocks(costs.picture);
    return work;
}

}  // namespace lightnet
