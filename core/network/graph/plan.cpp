#include "core/network/graph/plan.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <string>

#include "core/network/graph/layout.hpp"

namespace lightnet {
namespace {

/// Fills a plan host by host.
class Planner {
public:
    Planner(const Graph& graph, const Registry& registry, const Hosts& hosts)
        : graph_(graph), hosts_(hosts), sectors_(hosts.hosts.size()), placed_(graph.nodes.size(), false) {
        plan_.places_of.resize(graph.nodes.size());
        const auto used = used_nodes(graph, renderer_of(graph, registry));
        for (std::size_t node = 0; node < graph.nodes.size(); ++node)
            placed_[node] = used[whole_of(graph, node)] && sectors_of(graph, node).empty() &&
                            registry.find(graph.nodes[node].kind)->role != Role::scene;
        give_sectors();
    }

    /// What follows is about places of this host, until the next one begins.
    void begin_host(const std::string& host) {
        host_ = host;
        host_first_ = plan_.places.size();
    }

    /// Every place holds every node, but of sharded nodes only the sectors that are those of the entry; none: of a host
    /// that the file doesn't name.
    void whole_network(std::optional<std::size_t> entry, std::uint32_t places) {
        for (std::uint32_t index = 0; index < places; ++index) {
            const auto place = add_place();
            for (std::size_t node = 0; node < placed_.size(); ++node)
                if (placed_[node] && (!sector_at(graph_, node) || (entry && sectors_[*entry].contains(node))))
                    hold(node, place);
        }
    }

    /// Deals the named nodes out to the places of the entry, the least busy place first; places without a node are
    /// not made.
    void named_nodes(std::size_t entry, std::uint32_t places) {
        const std::size_t first = plan_.places.size();
        const auto& wanted_of = hosts_.hosts[entry].replicas;
        for (std::size_t node = 0; node < placed_.size(); ++node) {
            const auto wanted = wanted_of.find(graph_.nodes[whole_of(graph_, node)].name);
            if (wanted == wanted_of.end() || !placed_[node]) continue;
            places = std::max(places, static_cast<std::uint32_t>(wanted->second));
            const bool sector = sector_at(graph_, node);
            const int replicas = sector ? sectors_[entry].contains(node) : wanted->second;
            for (int replica = 0; replica < replicas; ++replica) hold(node, least_busy(first, places, node));
        }
    }

    /// Nodes that nobody holds go to the place that holds the fewest.
    void rescue_homeless() {
        for (std::size_t node = 0; node < placed_.size(); ++node)
            if (placed_[node] && plan_.places_of[node].empty()) {
                const auto fewest = std::min_element(held_.begin(), held_.end());
                hold(node, static_cast<std::uint32_t>(fewest - held_.begin()));
            }
    }

    /// What a node takes the frozen state of is beside it wherever it is.
    void keep_together() {
        const auto ranks = ranks_of(graph_);
        std::vector<std::size_t> takers(graph_.nodes.size());
        std::iota(takers.begin(), takers.end(), std::size_t{0});
        std::stable_sort(takers.begin(), takers.end(), [&](auto a, auto b) { return ranks[a] > ranks[b]; });
        for (const auto taker : takers)
            for (const auto taken : graph_.taken_by(taker))
                for (const auto place : plan_.places_of[taker]) {
                    const auto& holders = plan_.places_of[taken];
                    if (std::find(holders.begin(), holders.end(), place) == holders.end()) hold(taken, place);
                }
    }

    /// Names that are no strategy, or no node, have been complained of by check_hosts().
    void choose_strategies() {
        for (const auto& entry : hosts_.strategies) {
            const auto strategy = strategy_called(entry.name);
            const auto node = graph_.find(entry.node);
            if (strategy && entry.node.empty())
                plan_.strategy = *strategy;
            else if (strategy && node)
                choose(*node, *strategy);
        }
    }

    bool empty() const { return plan_.places.empty(); }

    Plan take() {
        for (auto& places : plan_.places_of) std::sort(places.begin(), places.end());
        return std::move(plan_);
    }

private:
    void choose(std::size_t node, Strategy strategy) {
        plan_.strategies[static_cast<std::uint32_t>(node)] = strategy;
        for (const auto sector : sectors_of(graph_, node))
            plan_.strategies[static_cast<std::uint32_t>(sector)] = strategy;
    }

    // Whose a sector is follows from the file alone, so that it stays where it is when other hosts come and go.
    void give_sectors() {
        for (std::size_t node = 0; node < written_nodes(graph_); ++node) {
            const auto sectors = sectors_of(graph_, node);
            if (sectors.empty()) continue;
            const auto counts = sectors_by_host(hosts_, graph_.nodes[node].name);
            auto next = sectors.begin();
            for (std::size_t entry = 0; entry < counts.size(); ++entry)
                for (std::uint32_t i = 0; i < counts[entry] && next != sectors.end(); ++i)
                    sectors_[entry].insert(*next++);
        }
    }

    std::uint32_t add_place() {
        plan_.places.push_back({host_, static_cast<std::uint32_t>(plan_.places.size() - host_first_)});
        held_.push_back(0);
        return static_cast<std::uint32_t>(plan_.places.size() - 1);
    }

    void hold(std::size_t node, std::uint32_t place) {
        plan_.places_of[node].push_back(place);
        ++held_[place];
    }

    // A place from `first` on that doesn't hold `node` yet: a new one while there may be more, else the least busy one.
    std::uint32_t least_busy(std::size_t first, std::uint32_t most, std::size_t node) {
        if (plan_.places.size() - first < most) return add_place();
        const auto& holders = plan_.places_of[node];
        std::size_t best = plan_.places.size();
        for (std::size_t place = first; place < plan_.places.size(); ++place) {
            if (std::find(holders.begin(), holders.end(), place) != holders.end()) continue;
            if (best == plan_.places.size() || held_[place] < held_[best]) best = place;
        }
        return static_cast<std::uint32_t>(best);
    }

    const Graph& graph_;
    const Hosts& hosts_;
    Plan plan_;
    std::string host_;                            // whose places are made now ...
    std::size_t host_first_ = 0;                  // ... and the first of them
    std::vector<std::set<std::size_t>> sectors_;  // by entry of the hosts file: those that it gives it
    std::vector<bool> placed_;                    // per node: the image needs it, and a place must hold it
    std::vector<std::size_t> held_;               // per place: how many nodes it holds
};

}  // namespace

Plan plan(const Graph& graph, const Registry& registry, const Hosts& hosts, const std::vector<HostOffer>& offers) {
    Planner planner(graph, registry, hosts);
    for (const auto& offer : offers) {
        planner.begin_host(offer.endpoint);
        bool named = false;
        for (std::size_t i = 0; i < hosts.hosts.size(); ++i) {
            const auto& entry = hosts.hosts[i];
            if (entry.host() != offer.endpoint) continue;
            named = true;
            const auto places = entry.places > 0 ? static_cast<std::uint32_t>(entry.places) : offer.places;
            if (entry.replicas.empty())
                planner.whole_network(i, places);
            else
                planner.named_nodes(i, places);
        }
        if (!named) planner.whole_network(std::nullopt, offer.places);
    }
    if (planner.empty()) throw Error("no host offers a place for a node that the picture needs");
    planner.rescue_homeless();
    planner.keep_together();
    planner.choose_strategies();
    return planner.take();
}

bool holds(const Plan& plan, const PlaceAt& place, std::size_t node) {
    return std::ranges::any_of(plan.places_of[node], [&](auto i) { return plan.places[i] == place; });
}

std::uint32_t places_of_host(const Plan& plan, std::string_view host) {
    return static_cast<std::uint32_t>(std::count_if(plan.places.begin(), plan.places.end(),
                                                    [&](const PlaceAt& place) { return place.host == host; }));
}

bool answers_alone(const Plan& plan, const Graph& graph, std::size_t node) {
    const auto used = used_nodes(graph, node);
    std::map<std::string, std::size_t> held;  // by host
    std::size_t needed = 0;
    const auto count = [&](std::size_t one) {
        std::set<std::string> hosts;
        for (const auto place : plan.places_of[one]) hosts.insert(plan.places[place].host);
        needed += !hosts.empty();
        for (const auto& host : hosts) ++held[host];
    };
    for (std::size_t one = 0; one < used.size(); ++one) {
        if (!used[one]) continue;
        count(one);
        for (const auto sector : sectors_of(graph, one)) count(sector);
    }
    return std::all_of(held.begin(), held.end(), [&](const auto& host) { return host.second == needed; });
}

bool fits(const Plan& plan, const Graph& graph) {
    const auto is_there = [&](std::uint32_t place) { return place < plan.places.size(); };
    return plan.places_of.size() == graph.nodes.size() &&
           std::all_of(plan.places_of.begin(), plan.places_of.end(),
                       [&](const auto& places) { return std::all_of(places.begin(), places.end(), is_there); });
}

}  // namespace lightnet
