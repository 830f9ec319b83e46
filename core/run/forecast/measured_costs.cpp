#include "core/run/forecast/measured_costs.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/run/forecast/place_work.hpp"

namespace lightnet {
namespace {

constexpr double settles_in = 0.7;    // seconds, in which a host's speed is believed to have changed
constexpr double forgets_in = 10;     // seconds, in which a host that has nothing to do is as quick as ever again
constexpr double remembers_for = 20;  // seconds of the run, by which its costs are known
constexpr double prior_seconds = 1;   // of all hosts, for which what was foreseen counts
constexpr double least_work = 0.1;    // seconds of places, from which a host's speed can be told
constexpr double least_share = 0.01;

double after(double seconds, double in) { return 1 - std::exp(-seconds / in); }

}  // namespace

MeasuredCosts::MeasuredCosts(const RunCosts& foreseen, const std::vector<ForecastHost>& hosts)
    : foreseen_(foreseen),
      hosts_(hosts),
      share_(hosts.size(), 1),
      work_(foreseen.nodes.size(), 0),
      questions_(foreseen.edges.size(), 0) {
    const auto work = work_by_node(foreseen);
    const double all = std::accumulate(work.begin(), work.end(), 0.0);
    double power = 0;
    for (const auto& host : hosts) power += host.power();
    if (all > 0) prior_ = usual_blocks(foreseen.picture) * prior_seconds * power / all;
}

void MeasuredCosts::take(const RunWindow& window) {
    double longest = 0;
    for (const auto& host : window.hosts) longest = std::max(longest, host.seconds);
    const double keeps = 1 - after(longest, remembers_for);
    for (auto& work : work_) work *= keeps;
    for (auto& questions : questions_) questions *= keeps;
    blocks_ = blocks_ * keeps + window.blocks;
    for (std::size_t edge = 0; edge < std::min(questions_.size(), window.questions.size()); ++edge)
        questions_[edge] += window.questions[edge];
    for (std::size_t host = 0; host < std::min(hosts_.size(), window.hosts.size()); ++host)
        take(host, window.hosts[host]);
}

void MeasuredCosts::take(std::size_t host, const HostWindow& window) {
    if (window.seconds <= 0) return;
    const double of_places = window.seconds * hosts_[host].places;
    const double worked = of_places * std::accumulate(window.busy.begin(), window.busy.end(), window.own);
    double& share = share_[host];
    if (worked < least_work) {
        share += (1 - share) * after(window.seconds, forgets_in);
        return;
    }
    const double now = std::clamp(window.processor / worked, least_share, 1.0);
    share *= std::pow(now / share, after(window.seconds, settles_in));
    for (std::size_t node = 0; node < std::min(work_.size(), window.busy.size()); ++node)
        work_[node] += of_places * window.busy[node] * now * hosts_[host].speed;
}

RunCosts MeasuredCosts::costs() const {
    RunCosts costs = foreseen_;
    const auto foreseen = questions_of_block(foreseen_);
    const double blocks = prior_ + blocks_;
    std::vector<double> asked(costs.nodes.size(), 0);
    asked[costs.image] = 1;
    for (auto node = costs.order.rbegin(); node != costs.order.rend(); ++node) {
        const double work = foreseen[*node] * foreseen_.nodes[*node].seconds * prior_ + work_[*node];
        if (asked[*node] > 0) costs.nodes[*node].seconds = work / blocks / asked[*node];
        costs.nodes[*node].preparing = {};
        for (std::size_t i = 0; i < costs.edges.size(); ++i) {
            auto& edge = costs.edges[i];
            if (edge.from != *node) continue;
            const double questions = (foreseen[*node] * foreseen_.edges[i].questions * prior_ + questions_[i]) / blocks;
            edge.questions = asked[*node] > 0 ? questions / asked[*node] : 0;
            asked[edge.to] += questions;
        }
    }
    return costs;
}

std::vector<ForecastHost> MeasuredCosts::hosts() const {
    auto hosts = hosts_;
    for (std::size_t host = 0; host < hosts.size(); ++host) hosts[host].speed *= share_[host];
    return hosts;
}

}  // namespace lightnet
