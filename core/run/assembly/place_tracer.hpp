// Records what a place is busy with, in a ring of fixed size.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/network/graph/graph.hpp"
#include "core/run/fiber/fiber.hpp"
#include "core/run/message/forwarding_carrier.hpp"
#include "core/run/message/place_trace.hpp"

namespace lightnet {

/// The newest events of one thread, and its alone. Outlives the place that it watches.
class PlaceTracer final : public FiberWatcher {
public:
    using Clock = std::chrono::steady_clock;

    PlaceTracer(const Graph& graph, std::size_t most_events);

    /// Of what the next fiber that starts does.
    void next_is(TraceKind kind) { next_ = kind; }
    void enters() override { entered_ = Clock::now(); }
    void left(const Fibers::Fiber* fiber, const char* owner, bool ended) override;
    /// Work without a fiber.
    void worked(TraceKind kind, std::size_t node, Clock::time_point begun) { add(kind, node, begun, 0); }
    /// A node of this place was called. What other fibers ran meanwhile is not a part of it.
    void called(std::size_t node, Clock::time_point begun);
    /// A bundle of that number, which is the same at both ends of its way.
    void sent(std::uint64_t id, std::size_t node, Clock::time_point begun) { add(TraceKind::send, node, begun, id); }
    void taken(std::uint64_t id, std::size_t node, Clock::time_point begun) { add(TraceKind::take, node, begun, id); }
    /// So many questions wait. Heard once a millisecond.
    void waiting(std::size_t questions);

    PlaceTrace take(const std::string& host, std::uint32_t index);

private:
    void add(TraceKind kind, std::size_t node, Clock::time_point begun, std::uint64_t id);

    std::map<std::string, std::uint32_t, std::less<>> nodes_;
    std::size_t most_;
    std::vector<TraceEvent> ring_;
    std::uint64_t count_ = 0;
    TraceKind next_ = TraceKind::light;
    std::map<const Fibers::Fiber*, TraceKind> kinds_;
    Clock::time_point entered_{}, heard_{};
};

/// A carrier that tells a tracer what leaves and what comes.
class TracingCarrier final : public ForwardingCarrier {
public:
    TracingCarrier(Carrier& carrier, PlaceTracer& tracer) : ForwardingCarrier(carrier), tracer_(tracer) {}
    bool ask(const PlaceAt& to, Message& message) override;
    std::optional<Message> receive() override;

private:
    PlaceTracer& tracer_;
};

}  // namespace lightnet
