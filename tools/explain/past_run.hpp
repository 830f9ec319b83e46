// A run that is over, as its report tells: what its picture was made of.
#pragma once

#include <cstdint>
#include <filesystem>

#include "core/network/graph/graph.hpp"
#include "core/network/graph/kind.hpp"

namespace lightnet {

/// A value.
struct PastRun {
    Graph graph;  // checked, without sectors; its files are named as seen from here
    std::uint64_t seed = 0;
};

/// What the report of a picture says (x.run.json). Throws UserError: there is none, it is of a version that doesn't say
/// it, or its graph is none of this program's.
PastRun read_past_run(const std::filesystem::path& report, const Registry& registry);

}  // namespace lightnet
