// The choice of the replica that is asked next.
#pragma once

#include <optional>

#include "core/run/schedule/schedule_state.hpp"

namespace lightnet {

/// Whom to ask for this work; none: nobody now. It counts what does not go to its home.
std::optional<ScheduleIds::Replica> choose(ScheduleState& state, const Backlog::Item& item);

}  // namespace lightnet
