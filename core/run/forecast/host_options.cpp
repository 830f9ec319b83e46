#include "core/run/forecast/host_options.hpp"

#include <algorithm>

namespace lightnet {
namespace {

constexpr std::size_t all_subsets = 6;  // nodes, of which a host may hold any
constexpr std::size_t most_heavy = 5;   // nodes whose memory counts, of which a host may hold any

double memory_of(const RunCosts& costs, const std::vector<bool>& held) {
    double bytes = 0;
    for (std::size_t node = 0; node < held.size(); ++node)
        if (held[node]) bytes += costs.nodes[node].memory;
    return bytes;
}

}  // namespace

bool has_room(const RunCosts& costs, const ForecastHost& host, const std::vector<bool>& held) {
    return host.memory <= 0 || memory_of(costs, held) <= host.memory;
}

std::vector<bool> needed_nodes(const RunCosts& costs) {
    std::vector<bool> needed(costs.nodes.size());
    for (const auto node : costs.order) needed[node] = true;
    return needed;
}

HostOptions::HostOptions(const RunCosts& costs, const std::vector<ForecastHost>& hosts, const std::vector<bool>& all)
    : costs_(costs), hosts_(hosts), options_(hosts.size()) {
    const auto nodes = weighed();
    for (std::size_t host = 0; host < hosts.size(); ++host) {
        add(host, std::vector<bool>(all.size(), false));
        for (std::size_t set = 0; set < std::size_t{1} << nodes.size(); ++set) {
            auto held = all;
            for (std::size_t i = 0; i < nodes.size(); ++i) held[nodes[i]] = set >> i & 1;
            add(host, held);
            add(host, closed(held));
        }
    }
}

std::vector<bool> HostOptions::with_taken(std::vector<bool> held) const {
    for (auto node = costs_.order.rbegin(); node != costs_.order.rend(); ++node)
        for (const auto& [taker, taken] : costs_.beside)
            if (taker == *node && held[taker]) held[taken] = true;
    return held;
}

// Nodes that ask nobody who is not there.
std::vector<bool> HostOptions::closed(std::vector<bool> held) const {
    for (const auto node : costs_.order)
        for (const auto& edge : costs_.edges)
            if (edge.from == node && !held[edge.to]) held[node] = false;
    return held;
}

// Of which nodes a host may hold any set; it may hold all others, or those that then ask nobody else, or none.
std::vector<std::size_t> HostOptions::weighed() const {
    std::vector<std::size_t> nodes;
    for (const auto node : costs_.order)
        if (costs_.order.size() <= all_subsets || costs_.nodes[node].memory > 0) nodes.push_back(node);
    const auto matters = [&](std::size_t node) { return costs_.nodes[node].memory; };
    std::stable_sort(nodes.begin(), nodes.end(), [&](auto a, auto b) { return matters(a) > matters(b); });
    if (costs_.order.size() > all_subsets && nodes.size() > most_heavy) nodes.resize(most_heavy);
    return nodes;
}

void HostOptions::add(std::size_t host, const std::vector<bool>& held) {
    const auto whole = with_taken(held);
    if (!has_room(costs_, hosts_[host], whole)) return;
    auto& options = options_[host];
    if (std::find(options.begin(), options.end(), whole) == options.end()) options.push_back(whole);
}

}  // namespace lightnet
