#include "tools/session/moves.hpp"

#include <algorithm>

#include "core/run/assembly/gauge.hpp"

namespace lightnet {
namespace {

constexpr double look_interval = 0.8;  // seconds: as often as hosts say what their places are at

// Hosts of which each names what it holds: an entry that names nothing would hold all.
Hosts named(const LaidOut& by, const Hosts& known) {
    Hosts said = known;
    for (auto& entry : said.hosts) {
        const auto host =
            std::find_if(by.hosts.begin(), by.hosts.end(), [&](const auto& one) { return one.name == entry.host(); });
        if (host == by.hosts.end()) continue;
        entry.places = static_cast<int>(host->places);
        entry.replicas.clear();
        const auto& holds = by.holds[static_cast<std::size_t>(host - by.hosts.begin())];
        for (const auto node : by.costs.order)
            entry.replicas[by.costs.nodes[node].name] = holds[node] ? entry.places : 0;
    }
    return said;
}

}  // namespace

Moves::Moves(const LaidOut& by, Of of)
    : of_(of),
      mover_(by),
      meter_(mover_.by().costs, asking_edges(of.graph, layers_of(of.graph, of.registry), of.registry),
             by.hosts.size()) {}

Plan Moves::plan(const std::vector<HostOffer>& there) const {
    const auto& by = mover_.by();
    auto hosts = named(by, of_.hosts);
    const auto holds_something = [&](const HostEntry& entry) {
        return std::any_of(there.begin(), there.end(), [&](const auto& o) { return o.endpoint == entry.host(); }) &&
               std::any_of(entry.replicas.begin(), entry.replicas.end(), [](const auto& one) { return one.second; });
    };
    if (std::none_of(hosts.hosts.begin(), hosts.hosts.end(), holds_something))
        for (auto& entry : hosts.hosts)
            entry.replicas.clear();  // all who held anything are gone: the rest takes it all
    Plan made = lightnet::plan(of_.graph, of_.registry, hosts, there);
    for (const auto& offer : there) {
        const auto host =
            std::find_if(by.hosts.begin(), by.hosts.end(), [&](const auto& one) { return one.name == offer.endpoint; });
        for (std::uint32_t place = 0; host != by.hosts.end() && place < host->places; ++place)
            if (const PlaceAt at{offer.endpoint, place};
                std::find(made.places.begin(), made.places.end(), at) == made.places.end())
                made.places.push_back(at);
    }
    return made;
}

std::optional<Move> Moves::look(double now, const std::function<std::vector<HostState>()>& hosts, double done,
                                double left) {
    if (now < next_look_) return std::nullopt;
    const bool first = next_look_ == 0;
    next_look_ = now + look_interval;
    const auto& by = mover_.by();
    for (const auto& state : hosts())
        for (std::size_t host = 0; host < by.hosts.size(); ++host)
            if (by.hosts[host].name == state.name) meter_.see(host, state.there, state.figures);
    auto window = meter_.next(done);
    if (first) return std::nullopt;  // nobody knows when it began
    window.seconds_left = left;
    auto move = mover_.look(now, window);
    changed_ = changed_ || move;
    return move;
}

}  // namespace lightnet
