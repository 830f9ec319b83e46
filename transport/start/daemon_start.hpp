// The first words of daemons.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "core/base/patience.hpp"

namespace lightnet {

/// For a daemon to say where it listens.
inline constexpr auto start_patience = std::chrono::seconds(20);

/// The first line of a daemon, which comes through `out`: "listening on ENDPOINT". None: it has ended, or is silent.
std::optional<std::string> endpoint_said(int out, Patience& patience);

}  // namespace lightnet
