// The patience of a run with hosts that are not ready when it begins.
#pragma once

#include <chrono>
#include <optional>

namespace lightnet {

/// A value.
struct HostPatience {
    HostPatience() = default;
    /// As patient with hosts of all three kinds.
    template <class Count, class Unit>
    HostPatience(std::chrono::duration<Count, Unit> all) : absent(all), nobody(all), slow(all) {}

    std::chrono::milliseconds absent{5000};           // with hosts that do not answer
    std::chrono::milliseconds nobody{5000};           // when none is there at all
    std::chrono::milliseconds slow{5000};             // with one that is still not ready when another is, at least
    std::chrono::milliseconds build{600000};          // when some are there, but none gets ready
    std::optional<std::chrono::milliseconds> busy{};  // when all serve other runs; none: as long as it takes
    std::optional<std::chrono::milliseconds> most{};  // whatever they do
};

}  // namespace lightnet
