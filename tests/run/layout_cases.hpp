// Layouts to be chosen, by seed: random networks on random hosts, and what the best of all layouts would take.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "core/run/forecast/forecast.hpp"
#include "core/run/forecast/placement.hpp"

namespace lightnet::test {

inline constexpr LineCost launcher{1.25e8, 2e-4};

struct LayoutCase {
    RunCosts costs;
    std::vector<ForecastHost> hosts;
};

/// Networks and hosts by a seed: half of the cases lack memory, a third have slow lines, a third prepare much.
class LayoutDice {
public:
    explicit LayoutDice(std::uint64_t seed) : seed_(seed), random_(seed * 7919 + 13) {}

    LayoutCase roll(std::size_t operators, std::size_t hosts) {
        LayoutCase made;
        network(made.costs, operators);
        for (std::size_t host = 0; host < hosts; ++host) made.hosts.push_back(this->host(host));
        if (seed_ % 2 == 0) lack_memory(made);
        return made;
    }

private:
    double part() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
    double between(double least, double most) { return least * std::pow(most / least, part()); }
    std::size_t one_of(std::size_t count) {
        return std::min(count - 1, static_cast<std::size_t>(part() * double(count)));
    }

    // Each asks some of those before it, the last is the renderer.
    void network(RunCosts& costs, std::size_t operators) {
        const bool prepares_much = seed_ % 3 == 1;
        for (std::size_t node = 0; node <= operators; ++node) {
            const bool image = node == operators;
            costs.nodes.push_back({image ? "image" : "op" + std::to_string(node), image ? 0.02 : between(2e-6, 4e-5)});
            costs.order.push_back(node);
            for (std::size_t to = 0; to < node; ++to)
                if (to + 1 == node || part() < 0.5)
                    costs.edges.push_back({node, to, image ? 2000 : between(0.3, 1.5), 60});
            if (image || part() < 0.4) continue;
            auto& preparing = costs.nodes[node].preparing;
            preparing = {
                .shards = 60, .shard_seconds = between(0.5, 3), .own_seconds = between(0.02, 0.2), .bytes = 1e6};
            if (prepares_much) preparing.shard_seconds *= 6, preparing.own_seconds *= 6;
            costs.nodes[node].memory = between(1e8, 4e9);
        }
        costs.image = operators;
        costs.picture = {320, 160, 16, 16};
    }

    ForecastHost host(std::size_t number) {
        ForecastHost host{.name = "host" + std::to_string(number), .places = std::uint32_t(1 + one_of(3))};
        host.speed = std::exp2(double(one_of(4)));
        if (seed_ % 3 == 0) host.line = part() < 0.5 ? LineCost{1.25e7, 1e-3} : LineCost{1.25e8, 5e-3};
        return host;
    }

    // No host has room for all; one has for all but the smallest, and another for that.
    void lack_memory(LayoutCase& made) {
        double all = 0, least = 1e18;
        for (const auto& node : made.costs.nodes) {
            all += node.memory;
            if (node.memory > 0) least = std::min(least, node.memory);
        }
        if (all <= 0) return;
        for (auto& host : made.hosts) host.memory = std::max(1.0, (0.3 + 0.6 * part()) * all - 1);
        const auto first = one_of(made.hosts.size());
        made.hosts[first].memory = std::max(1.001 * (all - least), 1.01 * least);
        auto& second = made.hosts[(first + 1) % made.hosts.size()].memory;
        second = std::max(second, 1.01 * least);
    }

    std::uint64_t seed_;
    std::mt19937_64 random_;
};

inline double seconds_of(const LayoutCase& made, const HeldByHosts& holds) {
    const auto found = forecast(made.costs, plan_of(holds, made.hosts), made.hosts, launcher, 1);
    return found.prepare + found.render;
}

inline bool covers(const LayoutCase& made, const HeldByHosts& holds) {
    return std::all_of(made.costs.order.begin(), made.costs.order.end(), [&](auto node) {
        return std::any_of(holds.begin(), holds.end(), [&](const auto& host) { return host[node]; });
    });
}

}  // namespace lightnet::test
