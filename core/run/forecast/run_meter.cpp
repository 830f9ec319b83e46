#include "core/run/forecast/run_meter.hpp"

#include <algorithm>

#include "core/run/forecast/place_work.hpp"

namespace lightnet {
namespace {

// Counts that came meanwhile; those of a host that was started anew begin at 0 again.
double grown(std::uint64_t now, std::uint64_t before) { return now > before ? double(now - before) : 0; }

std::uint64_t looks_of(const HostFigures& figures) {
    std::uint64_t looks = 0;
    for (const auto& place : figures.places) looks += place.busy + place.asking + place.waiting + place.idle;
    return looks;
}

std::uint64_t asking_of(const HostFigures& figures) {
    std::uint64_t looks = 0;
    for (const auto& place : figures.places) looks += place.asking;
    return looks;
}

}  // namespace

RunMeter::RunMeter(const RunCosts& costs, const std::vector<AskingEdge>& edges, std::size_t hosts)
    : costs_(costs), hosts_(hosts) {
    for (const auto& edge : edges) {
        const auto found = std::find_if(costs.edges.begin(), costs.edges.end(), [&](const auto& known) {
            return known.from == edge.from && known.to == edge.to;
        });
        counted_as_.push_back(found == costs.edges.end()
                                  ? std::nullopt
                                  : std::optional(static_cast<std::size_t>(found - costs.edges.begin())));
    }
}

void RunMeter::see(std::size_t host, bool there, const HostFigures& figures) {
    hosts_[host].there = there;
    hosts_[host].now = figures;
}

RunWindow RunMeter::next(double done) {
    RunWindow window;
    window.questions.assign(costs_.edges.size(), 0);
    window.blocks = std::max(0.0, done - done_) * usual_blocks(costs_.picture);
    window.left = 1 - done;
    done_ = done;
    for (auto& seen : hosts_) {
        window.hosts.push_back(window_of(seen));
        count_questions(seen, window.questions);
        seen.last = seen.now;
    }
    return window;
}

HostWindow RunMeter::window_of(const Seen& seen) const {
    const auto& [there, before, now] = seen;
    HostWindow window{.there = there, .busy = std::vector<double>(costs_.nodes.size(), 0)};
    const double looks = grown(looks_of(now), looks_of(before));
    if (before.clock_ns == 0 || looks == 0) return window;  // nobody knows when it began
    window.seconds = 1e-9 * grown(now.clock_ns, before.clock_ns);
    window.processor = 1e-9 * grown(now.processor_ns, before.processor_ns);
    window.own = grown(asking_of(now), asking_of(before)) / looks;
    for (std::size_t node = 0; node < std::min(now.nodes.size(), window.busy.size()); ++node) {
        const auto looks_before = node < before.nodes.size() ? before.nodes[node].looks : 0;
        window.busy[node] = grown(now.nodes[node].looks, looks_before) / looks;
    }
    return window;
}

void RunMeter::count_questions(const Seen& seen, std::vector<double>& questions) const {
    const auto& before = seen.last.edges;
    for (std::size_t edge = 0; edge < std::min(seen.now.edges.size(), counted_as_.size()); ++edge) {
        if (!counted_as_[edge]) continue;
        const auto asked_before = edge < before.size() ? before[edge].questions : 0;
        questions[*counted_as_[edge]] += grown(seen.now.edges[edge].questions, asked_before);
    }
}

}  // namespace lightnet
