// A first look at a picture whose nodes are still to prepare: the light of those that prepare nothing.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/network/graph/kind.hpp"
#include "core/run/assembly/job.hpp"
#include "tools/request/run_request.hpp"

namespace lightnet {

struct FirstLook {
    Job job;
    std::vector<std::string> without;  // layers that it lacks
};

/// None: nothing prepares, what is prepared is there from earlier runs, or nothing would be left to see.
std::optional<FirstLook> first_look(const RunRequest& request, const Registry& registry, const Job& job,
                                    const MadeFrom& made_from);

}  // namespace lightnet
