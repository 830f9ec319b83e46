#include "core/network/graph/check_hosts.hpp"

#include <algorithm>
#include <charconv>
#include <numeric>
#include <set>

#include "core/base/in_quotes.hpp"
#include "core/base/ip_address.hpp"
#include "core/network/graph/check_params.hpp"
#include "core/network/graph/layout.hpp"
#include "core/network/graph/strategy.hpp"

namespace lightnet {
namespace {

constexpr int most_places = 1024;  // of one host; more is a slip of the pen

/// One entry of the hosts file, and what is said of it.
class EntryCheck {
public:
    EntryCheck(const HostEntry& entry, std::vector<Problem>& problems) : entry_(entry), problems_(problems) {}

    void complain(const std::string& what) const {
        problems_.push_back({entry_.where, "place " + in_quotes(entry_.endpoint) + ": " + what});
    }

    void replica(const std::string& name, int count) const {
        if (count < 1 || count > most_places)
            complain("of " + in_quotes(name) + " it must hold 1 … " + std::to_string(most_places) + " replicas, not " +
                     std::to_string(count));
        else if (entry_.places > 0 && count > entry_.places)
            complain(std::to_string(count) + " replicas of " + in_quotes(name) + " need as many places, but it has " +
                     std::to_string(entry_.places));
    }

private:
    const HostEntry& entry_;
    std::vector<Problem>& problems_;
};

/// The entries of `strategy` or `layout`, and what is said of them.
class ChoiceCheck {
public:
    ChoiceCheck(std::string word, std::vector<std::string> known, const Graph& graph, const Registry& registry,
                std::vector<Problem>& problems)
        : word_(std::move(word)), known_(std::move(known)), graph_(graph), registry_(registry), problems_(problems) {}

    void complain(const ChoiceEntry& entry, const std::string& what) const {
        problems_.push_back({entry.where, word_ + (entry.node.empty() ? "" : " of " + in_quotes(entry.node)) + what});
    }

    /// The kind of the node that is named; null when the entry is for all, or makes no sense.
    const Kind* check(const ChoiceEntry& entry, const std::vector<std::string>& names) const {
        if (std::find(known_.begin(), known_.end(), entry.name) == known_.end())
            complain(entry, ": there is none called " + in_quotes(entry.name) + suggest(entry.name, known_));
        if (entry.node.empty()) return nullptr;
        const auto node = graph_.find(entry.node);
        const Kind* kind = node ? registry_.find(graph_.nodes[*node].kind) : nullptr;
        if (!node) complain(entry, ": there is no node of that name" + suggest(entry.node, names));
        if (kind && kind->role == Role::scene) complain(entry, ": it is a scene, which nobody asks");
        return kind && kind->role != Role::scene ? kind : nullptr;
    }

private:
    std::string word_;
    std::vector<std::string> known_;
    const Graph& graph_;
    const Registry& registry_;
    std::vector<Problem>& problems_;
};

std::string kinds_with_sectors(const Registry& registry) {
    std::string kinds;
    for (const auto& kind : registry.kinds())
        if (kind.run.landmarks) kinds += (kinds.empty() ? "" : ", ") + kind.name;
    return kinds.empty() ? "" : " (these can: " + kinds + ")";
}

void check_layouts(const Hosts& hosts, const Graph& graph, const Registry& registry,
                   const std::vector<std::string>& names, std::vector<Problem>& problems) {
    const ChoiceCheck check("layout", {layout_names.begin(), layout_names.end()}, graph, registry, problems);
    for (const auto& entry : hosts.layouts) {
        const Kind* kind = check.check(entry, names);
        if (!kind || layout_called(entry.name) != Layout::sharded) continue;
        const auto counts = sectors_by_host(hosts, entry.node);
        const auto sectors = std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
        const auto taker = std::find_if(graph.nodes.begin(), graph.nodes.end(), [&](const Node& node) {
            const auto taken = graph.taken_by(*graph.find(node.name));
            return std::any_of(taken.begin(), taken.end(), [&](auto i) { return graph.nodes[i].name == entry.node; });
        });
        if (taker != graph.nodes.end())
            check.complain(entry, ": it can't be sharded, as '" + taker->name + "' takes all that it keeps");
        else if (!kind->run.landmarks)
            check.complain(entry, ": a " + kind->name + " can't be sharded" + kinds_with_sectors(registry));
        else if (sectors < 2)
            check.complain(entry,
                           ": it takes two replicas or more to share it, but this file has " + std::to_string(sectors));
        else if (sectors > most_sectors)
            check.complain(
                entry, ": it can have " + std::to_string(most_sectors) + " sectors, not " + std::to_string(sectors));
    }
}

// What is written in numbers can be wrong without asking anybody.
void check_address(const EntryCheck& check, const HostEntry& entry) {
    const auto parts = address_of(entry.endpoint);
    if (!parts) return;
    if (is_mistaken_number(parts->host))
        return check.complain("no host is called " + in_quotes(parts->host) + ": it is neither an address nor a name");
    const auto address = ip_address(parts->host);
    if (address && address->six && address->is_link_local() && address->card.empty())
        check.complain("such an address takes the network card that leads there, as in [" + parts->host + "%eth0]");
}

}  // namespace

std::optional<Address> address_of(std::string_view endpoint) {
    const auto parts = tcp_endpoint(endpoint);
    if (!parts || parts->host.find('*') != std::string::npos) return std::nullopt;
    const std::string& digits = parts->port;
    int port = 0;
    const auto [end, fault] = std::from_chars(digits.data(), digits.data() + digits.size(), port);
    if (fault != std::errc{} || end != digits.data() + digits.size() || port < 1 || port > 65535) return std::nullopt;
    return Address{parts->host, port};
}

bool is_joining_name(std::string_view name) {
    return !name.empty() && name != own_process && name.size() <= 200 &&
           name.find_first_not_of(
               "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQ"
               "RSTUVWXYZ0123456789-_.") == name.npos;
}

void check_hosts(const Hosts& hosts, const Graph& graph, const Registry& registry, std::vector<Problem>& problems) {
    std::vector<std::string> names;
    for (const auto& node : graph.nodes)
        if (node.kind != "Scene") names.push_back(node.name);
    std::set<std::string> seen;
    for (const auto& entry : hosts.hosts) {
        const EntryCheck check(entry, problems);
        if (!entry.is_here() && !address_of(entry.endpoint) && !is_joining_name(entry.endpoint))
            check.complain(
                "a host is named like tcp://host:7777 or tcp://[fd00::7]:7777 (when it joins by itself, like onyx1; "
                "this process is called "
                "here)");
        check_address(check, entry);
        if (!entry.is_here() && !seen.insert(usual_text(entry.endpoint)).second)
            check.complain("the host stands here twice");
        if (entry.places < 0 || entry.places > most_places)
            check.complain("'places' must be 1 … " + std::to_string(most_places));
        for (const auto& [name, count] : entry.replicas) {
            const auto node = graph.find(name);
            const Kind* kind = node ? registry.find(graph.nodes[*node].kind) : nullptr;
            if (!node)
                check.complain("no node called " + in_quotes(name) + suggest(name, names));
            else if (kind && kind->role == Role::scene)
                check.complain(in_quotes(name) + " is a scene, which every host has");
            else
                check.replica(name, count);
        }
    }
    const ChoiceCheck strategies("strategy", {strategy_names.begin(), strategy_names.end()}, graph, registry, problems);
    for (const auto& entry : hosts.strategies) strategies.check(entry, names);
    check_layouts(hosts, graph, registry, names, problems);
}

}  // namespace lightnet
