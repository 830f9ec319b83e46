// The trace of one place: its activity, moment by moment.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace lightnet {

/// What an event of a trace is.
enum class TraceKind : std::uint32_t {
    prepare,  // work of a node, from when it began to run to when it ended or made way for others
    light,
    tiles,
    call,     // within that: a node of the same place that was called
    send,     // a bundle leaves
    take,     // a bundle has come
    waiting,  // how many questions wait here
};

/// Times are nanoseconds of the host's steady clock.
struct TraceEvent {
    std::uint64_t begin = 0, end = 0;
    std::uint64_t id = 0;  // send, take: of the bundle; waiting: how many
    std::uint32_t node = 0;
    TraceKind kind = TraceKind::light;
    friend bool operator==(const TraceEvent&, const TraceEvent&) = default;
};
static_assert(sizeof(TraceEvent) == 32 && std::is_trivially_copyable_v<TraceEvent>, "events travel as they are");

/// Of one thread that renders or deals. A value; travels as bytes.
struct PlaceTrace {
    std::string host;                // as in plans; "": the launcher's process
    std::uint32_t index = 0;         // any_place: the dispatcher of its host
    std::uint64_t dropped = 0;       // events that had to make room
    std::int64_t clock_ahead = 0;    // nanoseconds that the host's clock is ahead of the launcher's
    std::uint64_t clock_error = 0;   // at most; nanoseconds
    std::vector<TraceEvent> events;  // by their end
    friend bool operator==(const PlaceTrace&, const PlaceTrace&) = default;
};

std::string to_bytes(const std::vector<PlaceTrace>& traces);
/// Reads it back. Throws Error on anything else.
std::vector<PlaceTrace> place_traces_from(std::string_view bytes);

}  // namespace lightnet
