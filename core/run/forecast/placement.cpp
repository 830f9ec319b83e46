#include "core/run/forecast/placement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <numeric>
#include <random>
#include <set>

#include "core/base/error.hpp"
#include "core/run/forecast/forecast.hpp"
#include "core/run/forecast/place_work.hpp"

namespace lightnet {
namespace {

constexpr std::size_t played = 12;        // layouts, the best by the estimate
constexpr std::size_t most_steps = 3e7;   // of all estimates: some hundredths of a second
constexpr std::size_t most_played = 120;  // layouts, when the best is made better still
constexpr std::size_t kicks = 40;         // with which it looks beyond the best that steps lead to
constexpr double clearly_quicker = 0.95;  // than everything everywhere, when played ...
constexpr double perhaps_quicker = 0.9;   // ... and where there is only an estimate

/// Looks for the best layout, host by host.
class Search {
public:
    Search(const RunCosts& costs, const std::vector<ForecastHost>& hosts, const LineCost& launcher)
        : costs_(costs),
          hosts_(hosts),
          launcher_(launcher),
          estimate_(costs, hosts, launcher),
          all_(needed_nodes(costs)),
          options_(costs, hosts, all_) {}

    NodeLayout find() {
        const HeldByHosts everywhere(hosts_.size(), all_);
        const bool fits =
            std::all_of(hosts_.begin(), hosts_.end(), [&](const auto& host) { return has_room(costs_, host, all_); });
        if (fits) consider(everywhere);
        for (auto start : {covering(true), covering(false)}) descend(std::move(start));
        if (fits) descend(everywhere);
        for (std::size_t kick = 0; kick < kicks && !best_.empty() && steps_ < most_steps; ++kick)
            descend(kicked(best_.front().holds));
        if (best_.empty()) throw Error("no layout fits: " + widest());
        return choose(fits ? &everywhere : nullptr);
    }

private:
    // The best layouts so far, the first one first. Returns its seconds.
    double consider(const HeldByHosts& holds) {
        const double seconds = estimate_.seconds(holds);
        steps_ += estimate_.steps();
        const auto worse =
            std::find_if(best_.begin(), best_.end(), [&](const auto& known) { return known.seconds >= seconds; });
        const bool known = std::any_of(best_.begin(), best_.end(), [&](const auto& one) { return one.holds == holds; });
        if (!known && seconds < std::numeric_limits<double>::infinity()) best_.insert(worse, {holds, seconds, {}});
        if (best_.size() > played) best_.pop_back();
        return seconds;
    }

    // A layout in which each node is somewhere: what is largest first. `fill`: and wherever there is room.
    HeldByHosts covering(bool fill) const {
        HeldByHosts holds(hosts_.size(), std::vector<bool>(all_.size(), false));
        auto nodes = costs_.order;
        std::stable_sort(nodes.begin(), nodes.end(),
                         [&](auto a, auto b) { return costs_.nodes[a].memory > costs_.nodes[b].memory; });
        std::vector<double> load(hosts_.size(), 0);
        const auto work = work_by_node(costs_);
        const auto with = [&](std::size_t host, std::size_t node) {
            auto held = holds[host];
            held[node] = true;
            return options_.with_taken(held);
        };
        for (const auto node : nodes) {
            std::size_t best = hosts_.size();
            for (std::size_t host = 0; host < hosts_.size(); ++host)
                if (has_room(costs_, hosts_[host], with(host, node)) &&
                    (best == hosts_.size() || load[host] < load[best]))
                    best = host;
            if (best == hosts_.size()) continue;
            holds[best] = with(best, node);
            load[best] += work[node] / hosts_[best].power();
        }
        for (std::size_t host = 0; fill && host < hosts_.size(); ++host)
            for (const auto node : nodes)
                if (has_room(costs_, hosts_[host], with(host, node))) holds[host] = with(host, node);
        return holds;
    }

    // Takes what is best for all, host by host, as long as that helps and nobody has to wait; and two hosts at once,
    // where one has room only for what another gives up.
    void descend(HeldByHosts holds) {
        double seconds = consider(holds);
        const std::size_t end = steps_ + most_steps / 3;
        do
            while (step_of_one(holds, seconds, end)) {
            }
        while (step_of_two(holds, seconds, end));
    }

    // With other things on two of the hosts, whichever: where a descent ends that began elsewhere may be better.
    HeldByHosts kicked(HeldByHosts holds) {
        for (int i = 0; i < 2; ++i) {
            const auto host = random_() % hosts_.size();
            holds[host] = options_.of(host)[random_() % options_.of(host).size()];
        }
        return holds;
    }

    bool takes(HeldByHosts& holds, double& seconds, HeldByHosts other) {
        const double found = consider(other);
        if (found >= seconds * 0.9999) return false;
        holds = std::move(other), seconds = found;
        return true;
    }

    bool step_of_one(HeldByHosts& holds, double& seconds, std::size_t end) {
        bool better = false;
        for (std::size_t host = 0; host < hosts_.size(); ++host)
            for (const auto& option : options_.of(host)) {
                if (option == holds[host]) continue;
                if (steps_ >= end) return false;
                auto other = holds;
                other[host] = option;
                better |= takes(holds, seconds, std::move(other));
            }
        return better;
    }

    bool step_of_two(HeldByHosts& holds, double& seconds, std::size_t end) {
        for (std::size_t one = 0; one < hosts_.size(); ++one)
            for (std::size_t two = one + 1; two < hosts_.size(); ++two)
                for (const auto& of_one : options_.of(one))
                    for (const auto& of_two : options_.of(two)) {
                        if (of_one == holds[one] || of_two == holds[two]) continue;
                        if (steps_ >= end) return false;
                        auto other = holds;
                        other[one] = of_one, other[two] = of_two;
                        if (takes(holds, seconds, std::move(other))) return true;
                    }
        return false;
    }

    NodeLayout choose(const HeldByHosts* everywhere) {
        double places = 0;
        for (const auto& host : hosts_) places += host.places;
        const RunCosts costs = shortened(costs_, 150 * places);
        const bool plays = are_played(costs_, hosts_);
        const auto seconds_of = [&](const NodeLayout& layout) {
            if (!plays) return layout.seconds;
            const auto found = forecast(costs, plan_of(layout.holds, hosts_), hosts_, launcher_, 1);
            return found.prepare + found.render;
        };
        NodeLayout best = best_.front();
        double least = seconds_of(best);
        for (auto layout = std::next(best_.begin()); plays && layout != best_.end(); ++layout)
            if (const double seconds = seconds_of(*layout); seconds < least) least = seconds, best = *layout;
        if (plays) refine(best, least, seconds_of);
        if (everywhere && best.holds != *everywhere) {
            NodeLayout all{*everywhere, estimate_.seconds(*everywhere), {}};
            if (least >= (plays ? clearly_quicker : perhaps_quicker) * seconds_of(all)) best = std::move(all);
        }
        best.why = reasons(best.holds);
        return best;
    }

    // Host by host takes what is best when it is played.
    template <class SecondsOf>
    void refine(NodeLayout& best, double& least, const SecondsOf& seconds_of) {
        constexpr double worth = 0.995;
        std::size_t left = most_played;
        for (bool better = true; better && left > 0;) {
            better = false;
            for (std::size_t host = 0; host < hosts_.size(); ++host)
                for (const auto& option : options_.of(host)) {
                    if (option == best.holds[host] || left == 0) continue;
                    NodeLayout other = best;
                    other.holds[host] = option;
                    other.seconds = estimate_.seconds(other.holds);
                    if (other.seconds == std::numeric_limits<double>::infinity()) continue;
                    --left;
                    const double seconds = seconds_of(other);
                    if (seconds >= worth * least) continue;
                    best = std::move(other), least = seconds, better = true;
                }
        }
    }

    std::vector<std::string> reasons(const HeldByHosts& holds) const {
        std::vector<std::string> why;
        for (const auto node : costs_.order) {
            std::string room, quicker;
            for (std::size_t host = 0; host < hosts_.size(); ++host) {
                if (holds[host][node]) continue;
                auto held = holds[host];
                held[node] = true;
                const bool fits = has_room(costs_, hosts_[host], options_.with_taken(held));
                auto& names = fits ? quicker : room;
                names += (names.empty() ? "" : ", ") + hosts_[host].name;
            }
            const auto& name = costs_.nodes[node].name;
            if (!room.empty())
                why.push_back(fmt::format("{} is not on {}: beside the rest, its {:.0f} MiB have no room there", name,
                                          room, costs_.nodes[node].memory / 0x1p20));
            if (!quicker.empty()) why.push_back(fmt::format("{} is not on {}: it is quicker so", name, quicker));
        }
        if (why.empty()) why.emplace_back("everything is everywhere: memory allows it, and nothing is quicker");
        return why;
    }

    std::string widest() const {
        std::size_t widest = costs_.image;
        for (const auto node : costs_.order)
            if (costs_.nodes[node].memory > costs_.nodes[widest].memory) widest = node;
        return fmt::format("'{}' takes about {:.0f} MiB", costs_.nodes[widest].name,
                           costs_.nodes[widest].memory / 0x1p20);
    }

    const RunCosts& costs_;
    const std::vector<ForecastHost>& hosts_;
    LineCost launcher_;
    FlowEstimate estimate_;
    std::vector<bool> all_;  // nodes that the picture needs
    HostOptions options_;
    std::vector<NodeLayout> best_;
    std::size_t steps_ = 0;
    std::mt19937_64 random_;  // which is the same each time
};

}  // namespace

Plan plan_of(const HeldByHosts& holds, const std::vector<ForecastHost>& hosts) {
    Plan plan;
    plan.places_of.resize(holds.empty() ? 0 : holds.front().size());
    for (std::size_t host = 0; host < hosts.size(); ++host) {
        if (std::find(holds[host].begin(), holds[host].end(), true) == holds[host].end()) continue;
        for (std::uint32_t place = 0; place < hosts[host].places; ++place) {
            for (std::size_t node = 0; node < holds[host].size(); ++node)
                if (holds[host][node]) plan.places_of[node].push_back(static_cast<std::uint32_t>(plan.places.size()));
            plan.places.push_back({hosts[host].name, place});
        }
    }
    return plan;
}

Hosts hosts_of(const HeldByHosts& holds, const RunCosts& costs, const std::vector<ForecastHost>& hosts, Hosts known) {
    Hosts said = std::move(known);
    std::vector<HostEntry> entries;
    for (std::size_t host = 0; host < hosts.size(); ++host) {
        const auto found = std::find_if(said.hosts.begin(), said.hosts.end(),
                                        [&](const auto& entry) { return entry.host() == hosts[host].name; });
        HostEntry entry = found == said.hosts.end() ? HostEntry{hosts[host].name, {}, 0, {}} : *found;
        entry.places = static_cast<int>(hosts[host].places);
        entry.replicas.clear();
        const bool all =
            std::all_of(costs.order.begin(), costs.order.end(), [&](auto node) { return holds[host][node]; });
        bool any = all;
        for (const auto node : costs.order)
            if (holds[host][node] && !all) entry.replicas[costs.nodes[node].name] = entry.places, any = true;
        if (any) entries.push_back(std::move(entry));
    }
    said.hosts = std::move(entries);
    return said;
}

Hosts with_empty_hosts(const Hosts& said, const RunCosts& costs, Hosts known) {
    std::vector<HostEntry> entries;
    for (auto& entry : known.hosts) {
        const auto found = std::find_if(said.hosts.begin(), said.hosts.end(),
                                        [&](const auto& other) { return other.host() == entry.host(); });
        if (found != said.hosts.end()) {
            entries.push_back(*found);
        } else if (!entry.is_here()) {
            entry.replicas = {{costs.nodes[costs.image].name, 0}};  // none at all would say: the whole network
            entries.push_back(std::move(entry));
        }
    }
    known.hosts = std::move(entries);
    return known;
}

NodeLayout place_nodes(const RunCosts& costs, const std::vector<ForecastHost>& hosts, const LineCost& launcher) {
    if (hosts.empty()) throw Error("there are no hosts to lay it out on");
    return Search(costs, hosts, launcher).find();
}

}  // namespace lightnet
