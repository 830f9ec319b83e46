// A run from its request to its picture.
#pragma once

#include "core/network/graph/kind.hpp"
#include "tools/request/run_request.hpp"
#include "tools/support/signals.hpp"

namespace lightnet {

class Handover;

/// Renders, and writes the picture. `handover`: between the runs of a sequence; null: this one is alone. `signals` end
/// it; one that is superseded leaves nothing. Returns an exit code; throws UserError (a scene that is wrong;
/// PictureTaken: another run is at it) or Error.
int run(const RunRequest& request, const Registry& registry, Handover* handover = nullptr,
        const Signals& signals = watch_signals());

}  // namespace lightnet
