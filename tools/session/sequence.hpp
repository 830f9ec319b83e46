// Renders a sequence, frame by frame.
#pragma once

#include "core/network/graph/kind.hpp"
#include "tools/request/sequence.hpp"

namespace lightnet {

/// What doesn't change from frame to frame stays: hosts, what they hold, scenes and results of preparing. Frames that
/// another run is at are left to it. The first frame that fails ends the sequence. Returns an exit code. Throws
/// UserError or Error.
int run_sequence(Sequence sequence, const Registry& registry);

}  // namespace lightnet
