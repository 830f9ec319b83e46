// Which lightnet this is.
#pragma once

#include <string>

namespace lightnet {

/// "0.2.0"
std::string version();
/// Tells builds apart whose answers may differ: version, compiler, flags, and a hash of the sources that compute.
std::string build_id();

}  // namespace lightnet
