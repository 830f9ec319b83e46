// `--lighting auto`: which of the ways that have names suits a scene and a picture best.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/network/graph/hosts.hpp"
#include "tools/cli/launcher.hpp"
#include "tools/cli/options.hpp"
#include "tools/cli/render.hpp"
#include "tools/request/run_request.hpp"

namespace lightnet {

/// A scene that is to be lit in the best way, and its picture.
struct UnlitPicture {
    RenderedScene scene;              // its `lighting` is nothing yet
    RunningOptions running;           // with the picture's size and crop
    Hosts hosts;                      // of the run that will be
    std::shared_ptr<ReadScene> read;  // the scene, for the first trial; null: still to be read
};

/// Tries those that may be chosen, on this machine, whatever hosts the run has. Ways that these hosts, or options of
/// the picture, exclude are left out, which the words of the choice say. Throws UserError where none is left.
LightingOfRun lighting_by_trials_of(const UnlitPicture& picture, const Launcher& launcher);

/// What an earlier run of one of these pictures has chosen: it stays when they are gone on with. Its name is "" where
/// no report tells.
LightingOfRun lighting_of_earlier(const std::vector<std::string>& pictures);

}  // namespace lightnet
