// Hosts that might take part, as a command line says it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/network/graph/hosts.hpp"
#include "core/run/forecast/run_costs.hpp"

namespace lightnet {

/// "10Gbit,0.1ms", or either of them. None: it is neither.
std::optional<LineCost> line_called(const std::string& text, LineCost usual);
/// "16G". None: it is no size.
std::optional<double> bytes_called(const std::string& text);

/// Who might take part, and what the hosts file says of them.
struct ForecastCrew {
    Hosts entries;                    // as a hosts file has them
    std::vector<ForecastHost> hosts;  // each once, in their order
};

/// What the command line says of them.
struct ForecastHostsOptions {
    std::vector<std::string> hosts;           // hosts files, or NAME=PLACES
    std::string line = "1Gbit,0.2ms";         // of each, and of the launcher
    std::vector<std::string> lines;           // NAME=10Gbit,0.1ms
    std::vector<std::string> memory, speeds;  // 16G or NAME=16G; NAME=2
    std::vector<std::string> processors;      // NAME=1.5
};

/// "16G": of all of them; "NAME=16G": of that one. Throws UserError.
void limit_memory(std::vector<ForecastHost>& hosts, const std::string& text);

/// Throws UserError.
ForecastCrew crew_called(const ForecastHostsOptions& options);
/// So many places, `per_host` on each host but the last.
ForecastCrew crew_of_places(std::uint32_t places, std::uint32_t per_host, const ForecastHostsOptions& options);

}  // namespace lightnet
