// The request for a run, made of what the user typed.
#pragma once

#include "tools/cli/launcher.hpp"
#include "tools/cli/loading.hpp"
#include "tools/cli/options.hpp"
#include "tools/request/run_request.hpp"

namespace lightnet {

/// Also warns of what there is to warn of. Throws UserError where hosts are further away than the user has allowed.
RunRequest request_of(const RunningOptions& running, const Launcher& launcher, Loaded loaded);

}  // namespace lightnet
