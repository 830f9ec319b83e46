// Traces of places: a ring of fixed size, and its way as bytes.
#include "core/run/assembly/place_tracer.hpp"

#include <gtest/gtest.h>

#include "core/base/error.hpp"

namespace lightnet::place_tracer_test {
namespace {

Graph two_nodes() {
    Graph graph;
    graph.nodes = {{"light", "Ambient", {}, {}, {}}, {"image", "RayTracer", {}, {}, {}}};
    return graph;
}

TEST(PlaceTracer, KeepsTheNewestEventsAndCountsTheOthers) {
    PlaceTracer tracer(two_nodes(), 4);
    for (std::uint64_t id = 1; id <= 10; ++id) tracer.sent(id, 0, PlaceTracer::Clock::now());
    const PlaceTrace trace = tracer.take("host", 3);
    ASSERT_EQ(trace.events.size(), 4u);
    EXPECT_EQ(trace.dropped, 6u);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(trace.events[i].id, 7 + i) << "in their order";
}

TEST(PlaceTracer, SeesFibersComeAndGo) {
    PlaceTracer tracer(two_nodes(), 16);
    Fibers fibers;
    fibers.watch(&tracer);
    Fibers::Fiber* waiting = nullptr;
    tracer.next_is(TraceKind::tiles);
    fibers.start("image", [&] {
        waiting = fibers.current();
        fibers.park();
    });
    tracer.next_is(TraceKind::light);
    fibers.start("light", [] {});
    fibers.resume(waiting);
    const PlaceTrace trace = tracer.take("", 0);
    ASSERT_EQ(trace.events.size(), 3u);
    const std::pair<std::uint32_t, TraceKind> expected[]{
        {1, TraceKind::tiles}, {0, TraceKind::light}, {1, TraceKind::tiles}};
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(trace.events[i].node, expected[i].first);
        EXPECT_EQ(trace.events[i].kind, expected[i].second) << "a fiber keeps what it does";
        EXPECT_GE(trace.events[i].begin, i ? trace.events[i - 1].end : 0);
    }
}

TEST(PlaceTracer, SendsWhatItKeptAsBytes) {
    PlaceTrace one{"tcp://onyx:7777", 2, 17, 0, 0, {{1, 2, 3, 4, TraceKind::take}, {5, 6, 7, 8, TraceKind::waiting}}};
    const std::vector<PlaceTrace> traces{one, {"", 0, 0, 0, 0, {}}};
    const auto bytes = to_bytes(traces);
    EXPECT_EQ(place_traces_from(bytes), traces);
    for (std::size_t cut = 1; cut < 60; ++cut)
        EXPECT_THROW(place_traces_from(std::string_view(bytes).substr(0, cut)), Error) << cut;
    one.events[0].end = 0;
    EXPECT_THROW(place_traces_from(to_bytes({one})), Error) << "ends before it begins";
}

}  // namespace
}  // namespace lightnet::place_tracer_test
