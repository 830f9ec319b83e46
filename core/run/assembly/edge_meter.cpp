#include "core/run/assembly/edge_meter.hpp"

#include <algorithm>
#include <utility>

namespace lightnet {
namespace {

std::uint64_t since(std::chrono::nanoseconds begun, std::chrono::nanoseconds now) {
    return static_cast<std::uint64_t>(std::max<std::int64_t>(0, (now - begun).count()));
}

}  // namespace

EdgeMeter::Asking::Asking(EdgeMeter& meter, Measured& edge, std::size_t questions)
    : meter_(meter),
      record_(edge.record),
      before_(std::exchange(meter.gauge_.along, edge.shown)),
      questions_(questions),
      ran_before_(meter.running_()) {
    ++record_.asks;
    record_.questions += questions;
    edge.shown->questions.add(questions);
    if (meter.tracer_) called_at_ = std::chrono::steady_clock::now();
}

void EdgeMeter::Asking::begun(std::size_t asker, std::size_t asked, bool called) {
    const auto ran = since(ran_before_, meter_.running_());
    record_.called_ns += ran;
    if (meter_.learns_ && meter_.learns_(asker)) record_.learning += questions_, record_.learning_ns += ran;
    if (meter_.tracer_ && called) meter_.tracer_->called(asked, called_at_);
}

EdgeMeter::EdgeMeter(Gauge& gauge, std::vector<AskingEdge> shown, Running running)
    : gauge_(gauge), shown_(std::move(shown)), running_(std::move(running)) {}

// Who names an input twice has two edges to it: the first stands for both.
EdgeMeter::Measured& EdgeMeter::measured(std::size_t asker, std::size_t asked) {
    auto& edge = edges_[{asker, asked}];
    if (edge.shown) return edge;
    const auto found = std::find(shown_.begin(), shown_.end(), AskingEdge{asker, asked});
    edge.shown = found == shown_.end() ? &edge.own : &gauge_.edges[static_cast<std::size_t>(found - shown_.begin())];
    return edge;
}

void EdgeMeter::write(const Graph& graph, PlaceRecord& to) const {
    for (const auto& [ends, edge] : edges_) {
        if (!edge.record.asks) continue;
        auto& record = to.edges[{graph.nodes[ends.first].name, graph.nodes[ends.second].name}] = edge.record;
        record.bundles = edge.shown->bundles.get();
        record.sent = edge.shown->sent.get(), record.bytes = edge.shown->bytes.get();
    }
}

}  // namespace lightnet
