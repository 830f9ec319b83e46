// Layouts that others would choose: HEFT, the paper's by hand, and the best of a hundred by chance.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include "core/run/forecast/place_work.hpp"
#include "tests/run/layout_cases.hpp"

namespace lightnet::bench {

using test::LayoutCase;

/// Heterogeneous Earliest Finish Time (Topcuoglu et al. 2002): each node on the one host on which it would end first,
/// the nodes by how much work follows from them. Memory is what hosts have of it.
class Heft {
public:
    explicit Heft(const LayoutCase& made) : made_(made), work_(work_by_node(made.costs)) {
        const auto blocks = usual_blocks(made.costs.picture);
        questions_ = questions_of_block(made.costs);
        for (auto& count : questions_) count *= blocks;
        for (std::size_t node = 0; node < work_.size(); ++node) {
            const auto& preparing = made.costs.nodes[node].preparing;
            work_[node] += preparing.shard_seconds + preparing.own_seconds;
        }
    }

    HeldByHosts layout() {
        const auto& costs = made_.costs;
        std::vector<double> rank(work_.size(), 0);
        for (const auto node : costs.order) {
            for (const auto& edge : costs.edges)
                if (edge.from == node) rank[node] = std::max(rank[node], way(edge, mean_line()) + rank[edge.to]);
            rank[node] += work_[node] / mean_power();
        }
        auto order = costs.order;
        std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return rank[a] > rank[b]; });
        HeldByHosts holds(made_.hosts.size(), std::vector<bool>(work_.size(), false));
        std::vector<double> free(made_.hosts.size(), 0), ended(work_.size(), 0);
        std::vector<std::size_t> at(work_.size(), 0);
        for (const auto node : order) {
            double first = std::numeric_limits<double>::infinity();
            for (std::size_t host = 0; host < made_.hosts.size(); ++host) {
                auto held = holds[host];
                held[node] = true;
                if (!has_room(made_.costs, made_.hosts[host], held)) continue;
                double begin = free[host];
                for (const auto& edge : costs.edges)
                    if (edge.to == node && at[edge.from] != host)
                        begin = std::max(begin, ended[edge.from] + way(edge, made_.hosts[host].line));
                const double end = begin + work_[node] / (made_.hosts[host].places * made_.hosts[host].speed);
                if (end < first) first = end, at[node] = host;
            }
            if (first == std::numeric_limits<double>::infinity()) return {};
            holds[at[node]][node] = true;
            free[at[node]] = ended[node] = first;
        }
        return holds;
    }

private:
    double way(const EdgeCost& edge, const LineCost& line) const {
        return questions_[edge.from] * edge.questions * edge.bytes / line.bytes_per_second + line.seconds;
    }
    LineCost mean_line() const {
        LineCost mean{0, 0};
        for (const auto& host : made_.hosts) {
            mean.bytes_per_second += host.line.bytes_per_second / double(made_.hosts.size());
            mean.seconds += host.line.seconds / double(made_.hosts.size());
        }
        return mean;
    }
    double mean_power() const {
        double power = 0;
        for (const auto& host : made_.hosts) power += host.places * host.speed;
        return power / double(made_.hosts.size());
    }

    const LayoutCase& made_;
    std::vector<double> work_, questions_;
};

/// As the paper's Table 3 is laid out by hand: the most powerful host has all operators and does not render, all others
/// render, and the costlier half of the operators is on those as well. What has no room goes to the next host.
inline HeldByHosts layout_by_hand(const LayoutCase& made) {
    const auto work = work_by_node(made.costs);
    std::vector<std::size_t> hosts(made.hosts.size()), operators;
    std::iota(hosts.begin(), hosts.end(), std::size_t{0});
    const auto power = [&](std::size_t host) { return made.hosts[host].places * made.hosts[host].speed; };
    std::stable_sort(hosts.begin(), hosts.end(), [&](auto a, auto b) { return power(a) > power(b); });
    for (const auto node : made.costs.order)
        if (node != made.costs.image) operators.push_back(node);
    std::stable_sort(operators.begin(), operators.end(), [&](auto a, auto b) { return work[a] > work[b]; });
    HeldByHosts holds(made.hosts.size(), std::vector<bool>(work.size(), false));
    const auto give = [&](std::size_t host, std::size_t node) {
        auto held = holds[host];
        held[node] = true;
        if (!has_room(made.costs, made.hosts[host], held)) return false;
        holds[host] = std::move(held);
        return true;
    };
    for (const auto node : operators)
        for (const auto host : hosts)
            if (give(host, node)) break;
    for (const auto host : hosts) {
        if (host == hosts.front() && hosts.size() > 1) continue;
        give(host, made.costs.image);
        for (std::size_t i = 0; i < (operators.size() + 1) / 2; ++i) give(host, operators[i]);
    }
    return holds;
}

/// Seconds.
inline double best_by_chance(const LayoutCase& made, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    double least = std::numeric_limits<double>::infinity();
    for (int tries = 0, found = 0; found < 100 && tries < 100000; ++tries) {
        HeldByHosts holds(made.hosts.size(), std::vector<bool>(made.costs.nodes.size()));
        bool fits = true;
        for (std::size_t host = 0; host < holds.size(); ++host) {
            for (std::size_t node = 0; node < holds[host].size(); ++node) holds[host][node] = random() >> 40 & 1;
            fits = fits && has_room(made.costs, made.hosts[host], holds[host]);
        }
        if (!fits || !covers(made, holds)) continue;
        ++found;
        least = std::min(least, seconds_of(made, holds));
    }
    return least;
}

}  // namespace lightnet::bench
