// Sequences of what verbs are told of frames.
#pragma once

#include <functional>

#include "lua/load_graph.hpp"
#include "tools/cli/frames.hpp"
#include "tools/cli/launcher.hpp"
#include "tools/cli/options.hpp"

namespace lightnet {

/// Makes the run of one frame; `running`: as for that frame. Throws UserError.
using RunOfFrame = std::function<RunRequest(const GraphFrame& frame, const RunningOptions& running)>;

/// All runs of it, every one of them checked. Evaluates Lua, so call it before threads are started. Throws UserError
/// with what is wrong with the first frame that can't be, or with what is asked of all together.
Sequence sequence_of(const FrameOptions& frames, const RunningOptions& running, const RunOfFrame& run_of);

/// Renders them; an exit code.
int run_frames(const FrameOptions& frames, const RunningOptions& running, const Launcher& launcher,
               const RunOfFrame& run_of);

}  // namespace lightnet
