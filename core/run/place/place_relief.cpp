// Work that others take off a place that has more to do than they.
#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/run/place/full_bundle.hpp"
#include "core/run/place/place_ports.hpp"
#include "core/run/place/relief_terms.hpp"

namespace lightnet {
namespace {

constexpr auto relief_fades_in = std::chrono::duration<double>(relief::fades_in);

// Other places that hold the node, but not all that this one holds: such have as much to do as this one.
std::vector<std::uint32_t> helpers(const Plan& plan, const PlaceAt& me, std::size_t node) {
    std::vector<std::uint32_t> helpers;
    for (const auto place : plan.places_of[node]) {
        const auto lacks_one = [&](const std::vector<std::uint32_t>& held_by) {
            return std::ranges::find(held_by, place) == held_by.end() &&
                   std::ranges::any_of(held_by, [&](auto i) { return plan.places[i] == me; });
        };
        if (plan.places[place] != me && std::ranges::any_of(plan.places_of, lacks_one)) helpers.push_back(place);
    }
    return helpers;
}

}  // namespace

bool PlacePorts::called_here(std::size_t node) const { return at_.tuning.call_own_nodes && holds(plan_, at_.me, node); }

std::size_t PlacePorts::helpers_of(std::size_t node) const { return helpers(plan_, at_.me, node).size(); }

// Who is asked by bundles: where this place holds the node, its helpers, and it itself in reserve.
Plan PlacePorts::plan_for(std::size_t node) const {
    if (!called_here(node)) return plan_;
    Plan plan = plan_;
    const auto others = helpers(plan_, at_.me, node);
    std::erase_if(plan.places_of[node], [&](auto place) {
        return plan.places[place] != at_.me && std::find(others.begin(), others.end(), place) == others.end();
    });
    return plan;
}

void PlacePorts::lead(Key key, RoutingPort& port) {
    const auto count = called_here(key.first) ? helpers_of(key.first) : 0;
    port.use(called_here(key.first), count > 0);
    if (count == 0) return;
    const auto edges = asking_edges(at_.network.graph, at_.network.layers, at_.network.registry);
    const bool asks_on = std::ranges::any_of(edges, [&](const auto& edge) { return edge.from == key.first; });
    relieved_.push_back({key, &port, count, asks_on});
    if (const auto found = remotes_.find(key); found != remotes_.end()) found->second.port->keep_back(true);
}

void PlacePorts::share_out(Clock::time_point now) {
    for (const auto& relieved : relieved_) {
        const auto found = remotes_.find(relieved.key);
        if (found == remotes_.end()) continue;
        auto& [key, remote] = *found;
        while (const std::size_t waiting = remote.port->waiting()) {
            const auto size = std::min(full_bundle(at_.tuning.bundle, remote.own_seconds),
                                       std::max(waiting / (2 * (relieved.helpers + 1)), relief::least_bundle));
            auto& replicas = remote.port->replicas();
            if (!relief::may_go(replicas.scheduler().order(), std::min(size, waiting), waiting, remote.own_seconds)) {
                if (now - remote.faded >= relief_fades_in) remote.faded = now, replicas.fade(relief::fades_in);
                break;
            }
            remote.port->share(size);
        }
    }
}

bool PlacePorts::start_own() {
    for (const auto& relieved : relieved_) {
        const auto found = remotes_.find(relieved.key);
        if (found == remotes_.end() || found->second.port->waiting() == 0) continue;
        auto& remote = found->second;
        if (remote.own_fibers >= relief::most_own) continue;
        auto bundle = remote.port->take_back(relief::piece_of_own(
            remote.own_seconds, remote.port->waiting(), relieved.helpers, at_.tuning.bundle, relieved.asks_on));
        at_.fibers.start(at_.network.graph.nodes[relieved.key.first].name.c_str(),
                         [this, relieved, bundle = std::move(bundle)] { answer_own(relieved, bundle); });
        return true;
    }
    return false;
}

void PlacePorts::answer_own(const Relieved& relieved, const Bundle<Query>& bundle) {
    auto& remote = remotes_.at(relieved.key);
    const auto leave = [](Remote* left) { --left->own_fibers; };
    ++remote.own_fibers;
    const std::unique_ptr<Remote, decltype(leave)> counted(&remote, leave);  // also when the run ends meanwhile
    const auto& questions = *bundle.questions;
    std::vector<Rgb> answers(questions.size() * relieved.key.second);
    try {
        relieved.port->call().begin(questions, answers);
        remote.port->answered_here(bundle, answers);
    } catch (const NodeError& error) {
        remote.port->failed(bundle, {error.what(), error.host()});
    }
    const auto ran = at_.fibers.running_time(at_.fibers.current());
    at_.answered_own(relieved.key.first, ran);
    const double seconds = std::chrono::duration<double>(ran).count() / double(questions.size());
    remote.own_seconds = remote.own_seconds > 0 ? 0.8 * remote.own_seconds + 0.2 * seconds : seconds;
}

}  // namespace lightnet
