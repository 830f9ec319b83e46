// A sequence of frames, as it is asked for.
#pragma once

#include <string>
#include <vector>

#include "tools/request/run_request.hpp"

namespace lightnet {

/// Runs of the same hosts, ready to go, one for each frame, in the order in which they are wanted. A value.
struct Sequence {
    std::vector<RunRequest> frames;
    std::string report;  // file, beside those of the frames; "": none
};

}  // namespace lightnet
