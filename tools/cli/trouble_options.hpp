// Options that give local workers troubles.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "transport/start/fault_injection.hpp"

namespace CLI {
class App;
}  // namespace CLI

namespace lightnet {

/// --delay, --slow and --lose. They want --local-workers, which the verb must have.
void add_troubles(CLI::App& verb, FaultInjection& troubles);

/// What is wrong with them when there are so many local workers.
std::optional<std::string> mistake_in(const FaultInjection& troubles, std::uint32_t local_workers);

}  // namespace lightnet
