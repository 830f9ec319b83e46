// A run from its request to its picture.
#pragma once

#include "core/network/graph/kind.hpp"
#include "tools/request/run_request.hpp"

namespace lightnet {

/// Renders, and writes the picture. Returns an exit code; throws UserError (a scene that is wrong) or Error.
int run(const RunRequest& request, const Registry& registry);

}  // namespace lightnet
