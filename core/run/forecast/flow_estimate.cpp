#include "core/run/forecast/flow_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/run/forecast/place_work.hpp"

namespace lightnet {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

}  // namespace

FlowEstimate::FlowEstimate(const RunCosts& costs, const std::vector<ForecastHost>& hosts, const LineCost& launcher)
    : costs_(costs),
      hosts_(hosts),
      launcher_(launcher),
      blocks_(usual_blocks(costs.picture)),
      asked_(costs.nodes.size(), std::vector<double>(hosts.size())) {}

double FlowEstimate::seconds(const HeldByHosts& holds) {
    for (const auto node : costs_.order)
        if (std::none_of(holds.begin(), holds.end(), [&](const auto& host) { return host[node]; })) return infinite;
    return preparing(holds) + flow(holds);
}

// Pieces are shared by who holds the node; results come over the launcher's line; the rest each does for himself.
double FlowEstimate::preparing(const HeldByHosts& holds) const {
    double seconds = 0;
    for (const auto node : costs_.order) {
        const auto& cost = costs_.nodes[node].preparing;
        if (cost.shards == 0 && cost.own_seconds <= 0) continue;
        double power_of_all = 0, quickest = 0, holders = 0;
        for (std::size_t host = 0; host < hosts_.size(); ++host) {
            if (!holds[host][node]) continue;
            power_of_all += power(host), quickest = std::max(quickest, power(host)), ++holders;
        }
        seconds += cost.shard_seconds / power_of_all + cost.own_seconds / quickest +
                   cost.bytes * holders / launcher_.bytes_per_second;
    }
    return seconds;
}

// Others hold it who hold less: they answer some of what is asked here.
bool FlowEstimate::is_relieved(std::size_t node, std::size_t host, const HeldByHosts& holds) const {
    for (std::size_t other = 0; other < hosts_.size(); ++other) {
        if (other == host || !holds[other][node]) continue;
        for (std::size_t i = 0; i < holds[host].size(); ++i)
            if (holds[host][i] && !holds[other][i]) return true;
    }
    return false;
}

// Where the questions to a node are answered that come up at each host.
void FlowEstimate::answer(std::size_t node, const HeldByHosts& holds) {
    auto& asked = asked_[node];
    double bytes = 0, all = 0, weights = 0;
    for (const auto& edge : costs_.edges)
        if (edge.to == node) bytes = std::max(bytes, edge.bytes);
    for (std::size_t host = 0; host < hosts_.size(); ++host) {
        all += asked[host];
        if (holds[host][node]) weights += weight_[host];
    }
    double pool = 0, room = 0;
    for (std::size_t host = 0; host < hosts_.size(); ++host) {
        const double fair = holds[host][node] ? all * weight_[host] / weights : 0;
        const bool stays = holds[host][node] && (asked[host] <= fair || !is_relieved(node, host, holds));
        const double gives = stays ? 0 : asked[host] - fair;
        pool += gives, asked[host] -= gives;
        out_[host] += gives * bytes;
        room += std::max(0.0, fair - asked[host]);
    }
    for (std::size_t host = 0; host < hosts_.size() && pool > 0; ++host) {
        if (!holds[host][node]) continue;
        const double fair = all * weight_[host] / weights;
        const double takes =
            room > 0 ? pool * std::max(0.0, fair - asked[host]) / room : pool * weight_[host] / weights;
        asked[host] += takes;
        in_[host] += takes * bytes;
    }
}

double FlowEstimate::flow(const HeldByHosts& holds) {
    const double tiles = bytes_of_colour * costs_.picture.colours * costs_.picture.width * costs_.picture.height;
    const double least = tiles / launcher_.bytes_per_second;
    double best = infinite;
    weight_.assign(hosts_.size(), 0);
    for (std::size_t host = 0; host < hosts_.size(); ++host) weight_[host] = power(host);
    for (std::size_t round = 0; round < rounds; ++round) {
        busy_.assign(hosts_.size(), 0), in_.assign(hosts_.size(), 0), out_.assign(hosts_.size(), 0);
        for (auto& asked : asked_) std::fill(asked.begin(), asked.end(), 0.0);
        double weights = 0;
        for (std::size_t host = 0; host < hosts_.size(); ++host)
            if (holds[host][costs_.image]) weights += weight_[host];
        for (std::size_t host = 0; host < hosts_.size(); ++host)
            if (holds[host][costs_.image]) asked_[costs_.image][host] = blocks_ * weight_[host] / weights;
        for (auto node = costs_.order.rbegin(); node != costs_.order.rend(); ++node) {
            if (*node != costs_.image) answer(*node, holds);
            for (std::size_t host = 0; host < hosts_.size(); ++host)
                busy_[host] += asked_[*node][host] * costs_.nodes[*node].seconds;
            for (const auto& edge : costs_.edges)
                if (edge.from == *node)
                    for (std::size_t host = 0; host < hosts_.size(); ++host)
                        asked_[edge.to][host] += asked_[*node][host] * edge.questions;
        }
        double most = 0, sum = 0;
        for (std::size_t host = 0; host < hosts_.size(); ++host) {
            const double line = std::max(in_[host], out_[host]) / hosts_[host].line.bytes_per_second;
            busy_[host] = std::max(busy_[host] / power(host), line);
            most = std::max(most, busy_[host]), sum += busy_[host];
        }
        best = std::min(best, most);
        const double mean = sum / double(hosts_.size());
        for (std::size_t host = 0; host < hosts_.size(); ++host)
            weight_[host] *= std::clamp(std::pow(mean / std::max(busy_[host], 0.01 * mean), 0.7), 0.2, 4.0);
    }
    return std::max(best, least);
}

}  // namespace lightnet
