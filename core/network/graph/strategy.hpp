// Strategies by which an asker chooses among the replicas of a node.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace lightnet {

enum class Strategy : std::uint8_t {
    fastest,   // who is expected to finish first: outstanding work, fill level, measured service time
    affinity,  // the same region of the scene or image to the same replica, while it is not overloaded
};

/// As they are called in hosts files, in the order of the enum.
inline constexpr std::array<std::string_view, 2> strategy_names{"fastest", "affinity"};

constexpr std::string_view name_of(Strategy strategy) { return strategy_names[static_cast<std::size_t>(strategy)]; }

constexpr std::optional<Strategy> strategy_called(std::string_view name) {
    for (std::size_t i = 0; i < strategy_names.size(); ++i)
        if (strategy_names[i] == name) return static_cast<Strategy>(i);
    return std::nullopt;
}

}  // namespace lightnet
