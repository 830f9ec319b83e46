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
#include "core/run/message/carrier.hpp"
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
class TracingCarrier final : public Carrier {
public:
    TracingCarrier(Carrier& carrier, PlaceTracer& tracer) : carrier_(carrier), tracer_(tracer) {}
    bool ask(const PlaceAt& to, Message& message) override;
    void reply(Message message) override { carrier_.reply(std::move(message)); }
    std::optional<Message> receive() override;
    void wait(std::chrono::nanoseconds most) override { carrier_.wait(most); }
    void give_up(std::uint32_t channel) override { carrier_.give_up(channel); }
    bool bring(const PlaceAt& to, const Hash& name, const Bytes& bytes) override {
        return carrier_.bring(to, name, bytes);
    }
    void adopt(const Plan& plan) override { carrier_.adopt(plan); }
    bool take_out(const std::string& host, const std::string& why) override { return carrier_.take_out(host, why); }
    void doubt(const Failure& lie) override { carrier_.doubt(lie); }
    std::uint64_t pulse(const std::string& host) const override { return carrier_.pulse(host); }
    void forget(const PlaceAt& place) override { carrier_.forget(place); }
    const Counters& counters() const override { return carrier_.counters(); }

private:
    Carrier& carrier_;
    PlaceTracer& tracer_;
};

}  // namespace lightnet
