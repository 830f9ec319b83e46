// Renders a graph again and again, as it is edited.
#pragma once

#include "core/network/graph/kind.hpp"
#include "tools/request/session.hpp"

namespace lightnet {

/// Hosts, what they hold, and the scene as it was read and built stay from picture to picture. An edit ends the picture
/// at work, and the next begins: at one sample per pixel first, then more. A mistake costs its picture alone. Each
/// finished picture has the bytes that a run of its own would give. Returns an exit code.
int run_session(const Session& session, const Registry& registry);

}  // namespace lightnet
