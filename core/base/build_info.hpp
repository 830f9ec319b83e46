// The name of this build.
#pragma once

#include <string>

namespace lightnet {

/// "0.2.0"
std::string version();
/// Tells builds apart whose answers may differ: version, compiler, Embree, hashes of flags and decoders and of the
/// sources that answer or speak to others. Documents, tests, and what only users meet are not in it.
std::string build_id();

}  // namespace lightnet
