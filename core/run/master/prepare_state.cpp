#include "core/run/master/prepare_state.hpp"

#include <algorithm>
#include <utility>

namespace lightnet {

std::set<PlaceAt> places_of(const Plan& plan, std::size_t node) {
    std::set<PlaceAt> places;
    for (const auto place : plan.places_of[node]) places.insert(plan.places[place]);
    return places;
}

PrepareState::PrepareState(const Graph& of, const Registry& registry) : graph(of), order(of, registry) {
    proposed.places_of.resize(graph.nodes.size());
    in_force = proposed;
}

std::set<NodeCopy> PrepareState::copies_in_force(std::size_t position) const {
    std::set<NodeCopy> all;
    for (const auto node : order.nodes_at(position)) {
        const auto there = places_of(in_force, node);
        for (const auto& place : places_of(proposed, node))
            if (there.contains(place)) all.insert({place, node});
    }
    return all;
}

bool PrepareState::is_done(const NodeCopy& copy) const {
    const auto found = followers.find(copy);
    return found != followers.end() && found->second.state == Follower::State::done;
}

bool PrepareState::may_begin(const NodeCopy& copy, std::size_t position) const {
    for (std::size_t before = 0; before < order.stage(position); ++before)
        for (const auto& earlier : copies(before))
            if (earlier.place == copy.place && !is_done(earlier)) return false;
    return true;
}

// Nobody waits for the slowest: those who still build are asked when they are done.
// DECISIONS: not-for-the-slowest
bool PrepareState::can_be_asked(std::size_t position) const {
    if (!std::ranges::all_of(copies_in_force(position), [&](const auto& copy) { return is_done(copy); })) return false;
    return std::ranges::all_of(order.nodes_at(position), [&](std::size_t node) {
        return std::ranges::any_of(places_of(proposed, node), [&](const auto& at) { return is_done({at, node}); });
    });
}

bool PrepareState::all_past(std::size_t position, std::uint32_t call) const {
    return std::ranges::all_of(copies(position), [&](const NodeCopy& copy) {
        const auto found = followers.find(copy);
        if (found == followers.end()) return false;
        const auto& [state, at, left] = found->second;
        return state == Follower::State::done || (state != Follower::State::idle && at.call >= call);
    });
}

void PrepareState::propose(const Plan& plan) {
    std::vector<std::set<PlaceAt>> before, there;
    for (std::size_t node = 0; node < proposed.places_of.size(); ++node) before.push_back(places_of(proposed, node));
    for (std::size_t node = 0; node < plan.places_of.size(); ++node) there.push_back(places_of(plan, node));
    proposed = plan;
    for (auto& [copy, follower] : followers)
        if (there[copy.node].contains(copy.place))
            follower.left = 0;
        else if (before[copy.node].contains(copy.place))
            follower.left = steady_seconds();
}

}  // namespace lightnet
