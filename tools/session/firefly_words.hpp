// Words about the fireflies of a picture: how many, and what to do about them.
#pragma once

#include <string>
#include <vector>

#include "core/film/picture.hpp"
#include "tools/support/run_report.hpp"

namespace lightnet {

/// "": there are none. `exr`: file of the picture; `nodes`: of the graph that made it, whose photon maps, or lack of
/// them, tell which graph would cover better what paths meet by chance.
std::string firefly_words(const Picture& picture, const std::vector<NodeReport>& nodes, const std::string& exr);

}  // namespace lightnet
