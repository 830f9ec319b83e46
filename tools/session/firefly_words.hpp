// Words about the noise of a picture: fireflies, which light paths make them, and what to do about it.
#pragma once

#include <string>

#include "core/film/picture.hpp"
#include "tools/support/run_report.hpp"

namespace lightnet {

/// "": there are no fireflies, and no graph is known that covers better what makes the error. `exr`: file of the
/// picture; `report`: what is known of the noise, and the nodes of the graph, which tell what covers its paths already.
std::string firefly_words(const Picture& picture, const RunReport& report, const std::string& exr);

}  // namespace lightnet
