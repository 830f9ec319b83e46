// The end of a wait that nobody wants any more.
#pragma once

namespace lightnet {

/// Thrown out of a wait when the work is no longer wanted. Nothing but the end of that work should catch it.
struct Cancelled {};

}  // namespace lightnet
