// Numbers by which the parts of a scheduler name things.
#pragma once

#include <cstdint>

namespace lightnet {

/// A namespace of types.
struct ScheduleIds {
    using Time = double;            // seconds, on any clock that does not go back
    using WorkId = std::uint64_t;   // a bundle or a tile that is wanted; never used again
    using CopyId = std::uint64_t;   // one sending of it; never used again
    using Replica = std::uint32_t;  // a number that the caller gives; small, and used again
    using Host = std::uint32_t;     // likewise; the replicas of a host die together
};

}  // namespace lightnet
