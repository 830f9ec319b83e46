#include "core/run/assembly/place_tracer.hpp"

#include <algorithm>
#include <utility>

#include "core/base/math/random.hpp"

namespace lightnet {
namespace {

std::uint64_t trace_time(PlaceTracer::Clock::time_point time) {
    return static_cast<std::uint64_t>(std::chrono::nanoseconds(time.time_since_epoch()).count());
}

// The same at both ends of the way; who is asked for nothing, or by the launcher, has none.
std::uint64_t flow_of(const Message& ask) {
    const bool light = std::holds_alternative<Questions<Query>>(ask.questions);
    if (ask.type != Message::Type::ask || !ask.asker || !light) return 0;
    return child(ask.asker, ask.bundle, ask.channel) | 1;
}

}  // namespace

PlaceTracer::PlaceTracer(const Graph& graph, std::size_t most_events) : most_(std::max<std::size_t>(1, most_events)) {
    for (std::size_t node = 0; node < graph.nodes.size(); ++node)
        nodes_.emplace(graph.nodes[node].name, static_cast<std::uint32_t>(node));
    ring_.reserve(most_);
}

void PlaceTracer::add(TraceKind kind, std::size_t node, Clock::time_point begun, std::uint64_t id) {
    const TraceEvent event{trace_time(begun), trace_time(Clock::now()), id, static_cast<std::uint32_t>(node), kind};
    if (ring_.size() < most_)
        ring_.push_back(event);
    else
        ring_[count_ % most_] = event;
    ++count_;
}

void PlaceTracer::left(const Fibers::Fiber* fiber, const char* owner, bool ended) {
    const auto known = kinds_.try_emplace(fiber, next_).first;
    const auto node = nodes_.find(std::string_view(owner));
    if (node != nodes_.end()) add(known->second, node->second, entered_, 0);
    if (ended) kinds_.erase(known);
}

void PlaceTracer::called(std::size_t node, Clock::time_point begun) {
    add(TraceKind::call, node, std::max(begun, entered_), 0);
}

void PlaceTracer::waiting(std::size_t questions) {
    const auto now = Clock::now();
    if (now - heard_ < std::chrono::milliseconds(1)) return;
    heard_ = now;
    add(TraceKind::waiting, 0, now, questions);
}

PlaceTrace PlaceTracer::take(const std::string& host, std::uint32_t index) {
    PlaceTrace trace;
    trace.host = host, trace.index = index;
    trace.dropped = count_ - ring_.size();
    if (trace.dropped)
        std::rotate(ring_.begin(), ring_.begin() + static_cast<std::ptrdiff_t>(count_ % most_), ring_.end());
    trace.events = std::exchange(ring_, {});
    return trace;
}

bool TracingCarrier::ask(const PlaceAt& to, Message& message) {
    const auto begun = PlaceTracer::Clock::now();
    const auto id = flow_of(message);  // it may be gone afterwards
    const auto node = message.node;
    if (!carrier_.ask(to, message)) return false;
    if (id) tracer_.sent(id, node, begun);
    return true;
}

std::optional<Message> TracingCarrier::receive() {
    const auto begun = PlaceTracer::Clock::now();
    auto message = carrier_.receive();
    if (const auto id = message ? flow_of(*message) : 0) tracer_.taken(id, message->node, begun);
    return message;
}

}  // namespace lightnet
