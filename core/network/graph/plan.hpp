// The plan: who answers for which node, computed from a graph and from the hosts that are there. A plain value.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "core/film/addition.hpp"
#include "core/network/graph/graph.hpp"
#include "core/network/graph/hosts.hpp"
#include "core/network/graph/kind.hpp"
#include "core/network/graph/strategy.hpp"

namespace lightnet {

/// A colour that is kept apart from all others: the light of a node, or of a group of lamps by way of it.
struct Terminal {
    std::size_t node = 0;
    std::uint32_t group = 0;  // of lamps; 0 where the node keeps none apart
    friend auto operator<=>(const Terminal&, const Terminal&) = default;
};

/// What the image's layers are, and which of them pass through each node. Depends on the graph alone.
struct Layers {
    std::vector<std::string> film;  // "emission", then the terminals of the additive paths, graph order: "direct". Of
                                    // what keeps groups of lamps apart, one for each: "direct.key", "direct.rest".
                                    // What the same light path expression takes is one
    std::vector<std::uint32_t> of_colour;  // per colour that reaches the renderer (its own, then its terminals'): the
                                           // layer that it is added to
    std::vector<std::size_t> shown;        // nodes whose images stand beside the sum, behind the layers of the film
    std::vector<std::uint32_t> ids;        // of each of those: how many ids a pixel keeps of it; 0: it is one colour
    std::vector<std::uint32_t> halved;     // of which colours the second half of the samples is kept, too: see
                                           // add_cleaning(). Those halves stand behind all that is shown
    bool alpha = false;                    // the last colour says how much of a pixel surfaces cover
    std::vector<std::vector<Terminal>> of_node;  // per node: the terminals that its answers keep apart
    std::size_t emission = 1;                    // how many layers the renderer's own light has, the first ones
    std::size_t groups = 1;                      // of lamps, that nodes keep apart who do
    std::vector<bool> by_group;                  // per node: its answers keep them apart
};

/// The first colour of an image beside the sum, by its number there; of the number behind the last: that of alpha.
std::size_t first_colour(const Layers& layers, std::size_t shown);
/// How many colours a pixel has: one per layer, one or as many as ids per image beside the sum, one for each half, and
/// one for alpha.
std::size_t colours_of(const Layers& layers);
/// How they are added up.
Addition addition_of(const Layers& layers);
/// The names of the images beside the sum: of nodes, and then of halves.
std::vector<std::string> shown_names(const Layers& layers, const Graph& graph);

/// Layers of a checked graph. A linear node on an additive path from the renderer keeps its terminals apart; every
/// other node answers with one colour.
Layers layers_of(const Graph& graph, const Registry& registry);
/// The layers of the film that are a node's light, added up; none: it is no part of the sum, or in layers with others'.
std::vector<std::size_t> layers_made_of(std::size_t node, const Layers& layers, const Graph& graph,
                                        const Registry& registry);
/// What is wrong with the light path expressions of a graph that is sound otherwise.
std::vector<Problem> mistaken_layers(const Graph& graph, const Registry& registry);
/// Of its light as a layer: "direct", "direct.key".
std::string name_of(const Terminal& terminal, const Layers& layers, const Graph& graph, const Registry& registry);

/// Names one place: the same on every host, and in order.
struct PlaceAt {
    std::string host;         // endpoint of its host; "" for places of this process
    std::uint32_t index = 0;  // among the places of its host
    friend auto operator<=>(const PlaceAt&, const PlaceAt&) = default;
};

/// All places of a run, and which of them answer for each node. One that is there and holds no node any more answers
/// what it has, and is asked no more; one that is gone has left its work undone.
struct Plan {
    std::vector<PlaceAt> places;
    std::vector<std::vector<std::uint32_t>> places_of;  // node index → places (indices) that hold it; scenes, and nodes
                                                        // that have sectors: none
    Strategy strategy = Strategy::fastest;           // by which askers choose among the places of a node ...
    std::map<std::uint32_t, Strategy> strategies{};  // ... but of these nodes

    std::map<std::string, std::uint64_t> processes{};  // host → which process serves there, as far as is known: who
                                                       // comes back as the same one had not died
    std::uint32_t edition = 0;  // how many were in force before it, of this run; 0: it is not in force

    std::uint64_t process_of(const std::string& host) const {
        const auto known = processes.find(host);
        return known == processes.end() ? 0 : known->second;
    }
    Strategy strategy_of(std::size_t node) const {
        const auto own = strategies.find(static_cast<std::uint32_t>(node));
        return own == strategies.end() ? strategy : own->second;
    }
    /// Do they say the same? Whatever their editions.
    friend bool operator==(const Plan& a, const Plan& b) {
        const auto said = [](const Plan& plan) {
            return std::tie(plan.places, plan.places_of, plan.strategy, plan.strategies, plan.processes);
        };
        return said(a) == said(b);
    }
};

/// How many places a host offers.
struct HostOffer {
    std::string endpoint;
    std::uint32_t places = 1;
};

/// Spreads the graph over the hosts that are there. Without a hosts file (or where an entry names no nodes) each place
/// holds the whole network. Several entries for this process have their places one behind the other, in the order of
/// the file. A node whose hosts are all absent is put on the place that holds the fewest nodes. Sectors
/// of sharded nodes go to the hosts of the file in its order; hosts that it doesn't name hold only those that have lost
/// theirs, and nobody holds the sharded node itself. Who takes a node's frozen state has that node beside it on all its
/// places.
Plan plan(const Graph& graph, const Registry& registry, const Hosts& hosts, const std::vector<HostOffer>& offers);

/// Does this place hold the node?
bool holds(const Plan& plan, const PlaceAt& place, std::size_t node);

/// How many places a host has.
std::uint32_t places_of_host(const Plan& plan, std::string_view host);

/// Whether each host that answers for `node` does so without others: it holds all that `node` uses, and nobody holds a
/// part of that, to whom it could hand on questions.
bool answers_alone(const Plan& plan, const Graph& graph, std::size_t node);

/// Every node of the graph has a row, and every place that is named is there. Plans that arrive are checked.
bool fits(const Plan& plan, const Graph& graph);

/// The index of the renderer whose image the run makes.
std::size_t renderer_of(const Graph& graph, const Registry& registry);

/// Canonical text of a plan, and back; limits and errors as for graphs.
std::string to_json(const Plan& plan);
Plan plan_from_json(std::string_view text);

}  // namespace lightnet
