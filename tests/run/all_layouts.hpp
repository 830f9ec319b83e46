// All layouts that there are of a case, and the best of them: brute force, but for those that can't be the best.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "core/run/forecast/place_work.hpp"
#include "tests/run/layout_cases.hpp"

namespace lightnet::test {

/// Lists the layouts that fit, and plays them by what they take at least: from the first that takes longer than the
/// best so far, none needs to be played. `made` must outlive it.
class AllLayouts {
public:
    explicit AllLayouts(const LayoutCase& made) : made_(made), nodes_(made.costs.nodes.size()) {
        const auto work = work_by_node(made.costs);
        for (std::size_t node = 0; node < nodes_; ++node) {
            const auto& preparing = made.costs.nodes[node].preparing;
            work_.push_back({work[node], preparing.shard_seconds, preparing.own_seconds});
        }
        for (const auto& host : made.hosts) {
            powers_.push_back(host.places * host.speed);
            sets_.emplace_back();
            for (std::uint32_t set = 0; set < std::uint32_t{1} << nodes_; ++set)
                if (has_room(made.costs, host, held(set))) sets_.back().push_back(set);
        }
        list(0, {});
        std::sort(layouts_.begin(), layouts_.end(), [](const auto& a, const auto& b) {
            return a.least != b.least ? a.least < b.least : a.sets < b.sets;
        });
    }

    struct Best {
        HeldByHosts holds;
        double seconds = std::numeric_limits<double>::infinity();
        std::size_t played = 0;
    };
    /// `known`: seconds of a layout that is known already, so that fewer need to be played.
    Best best(double known = std::numeric_limits<double>::infinity()) const {
        Best best;
        for (const auto& layout : layouts_) {
            if (layout.least > std::min(known, best.seconds)) break;
            const auto holds = held(layout.sets);
            const double seconds = seconds_of(made_, holds);
            ++best.played;
            if (seconds < best.seconds) best.seconds = seconds, best.holds = holds;
        }
        return best;
    }
    std::size_t size() const { return layouts_.size(); }

    /// Seconds that none of its places can save: for every set of nodes, what they take of the hosts that hold any.
    double least_seconds(const std::vector<std::uint32_t>& sets) const {
        double rendering = 0, preparing = 0;
        for (std::uint32_t set = 1; set < std::uint32_t{1} << nodes_; ++set) {
            double power = 0, work = 0, shards = 0;
            for (std::size_t host = 0; host < sets.size(); ++host)
                if (sets[host] & set) power += powers_[host];
            for (std::size_t node = 0; node < nodes_; ++node)
                if (set >> node & 1) work += work_[node].rendering, shards += work_[node].shards;
            rendering = std::max(rendering, work / power);
            preparing = std::max(preparing, shards / power);
        }
        for (std::size_t node = 0; node < nodes_; ++node) preparing = std::max(preparing, own_preparing(sets, node));
        return not_carried * (rendering + preparing);
    }

private:
    // Parts of questions that wait for more of them when the last tile ends.
    static constexpr double not_carried = 0.995;

    struct Work {
        double rendering, shards, own;
    };
    struct Layout {
        double least;
        std::vector<std::uint32_t> sets;  // by host: a bit for each node
    };

    double own_preparing(const std::vector<std::uint32_t>& sets, std::size_t node) const {
        double power = 0, quickest = 0;
        for (std::size_t host = 0; host < sets.size(); ++host) {
            if (!(sets[host] >> node & 1)) continue;
            power += powers_[host], quickest = std::max(quickest, powers_[host]);
        }
        return work_[node].shards / power + work_[node].own / quickest;
    }
    std::vector<bool> held(std::uint32_t set) const {
        std::vector<bool> nodes(nodes_);
        for (std::size_t node = 0; node < nodes_; ++node) nodes[node] = set >> node & 1;
        return nodes;
    }
    HeldByHosts held(const std::vector<std::uint32_t>& sets) const {
        HeldByHosts holds;
        for (const auto set : sets) holds.push_back(held(set));
        return holds;
    }
    void list(std::uint32_t covered, std::vector<std::uint32_t> sets) {
        if (sets.size() == sets_.size()) {
            if (covered + 1 == std::uint32_t{1} << nodes_) layouts_.push_back({least_seconds(sets), sets});
            return;
        }
        for (const auto set : sets_[sets.size()]) {
            sets.push_back(set);
            list(covered | set, sets);
            sets.pop_back();
        }
    }

    const LayoutCase& made_;
    std::size_t nodes_;
    std::vector<Work> work_;
    std::vector<double> powers_;                    // by host: of all its places
    std::vector<std::vector<std::uint32_t>> sets_;  // by host: those that it has room for
    std::vector<Layout> layouts_;
};

}  // namespace lightnet::test
