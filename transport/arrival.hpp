// A job as it arrives at a host: from anybody who reaches its port.
#pragma once

#include <string>

#include "core/graph/kind.hpp"
#include "core/graph/plan.hpp"
#include "core/runtime/job.hpp"

namespace lightnet {

/// Longest texts that are read at all.
inline constexpr std::size_t most_job_bytes = std::size_t{32} << 20;

struct Arrival {
    Job job;
    Plan plan;
};

/// Reads and checks what a packet `begin` says. May take a while. Throws Error when it is no job of ours.
Arrival read_arrival(const std::string& job, const std::string& plan, const Registry& registry);

}  // namespace lightnet
