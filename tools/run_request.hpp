// From what the user typed to a run that is ready to go.
#pragma once

#include "tools/launcher.hpp"
#include "tools/loading.hpp"
#include "tools/options.hpp"
#include "tools/run.hpp"

namespace lightnet {

/// Also warns of what there is to warn of. Throws UserError where hosts are further away than the user has allowed.
RunRequest request_of(const RunningOptions& running, const Launcher& launcher, Loaded loaded);

}  // namespace lightnet
